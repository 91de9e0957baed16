"""Where bodies, points and axes are at one time, and how they move: what free-body diagrams are drawn on."""

from dataclasses import dataclass

import numpy as np


def vector(x, y):
    return np.array([x, y], dtype=float)


def turned(v):
    """v turned by +90 degrees."""
    return vector(-v[1], v[0])


def cross(v, w):
    """The only component of the cross product that vectors of the plane have."""
    return v[0] * w[1] - v[1] * w[0]


def unit(v):
    return v / np.hypot(*v)


def polar(angle):
    return vector(np.cos(angle), np.sin(angle))


@dataclass
class Body:
    """A body's frame: place and angle, with their first and second time derivatives."""

    name: str
    origin: np.ndarray
    phi: float
    velocity: np.ndarray
    omega: float
    acceleration: np.ndarray
    alpha: float

    def along(self, v):
        """A direction or length of the body's frame, in the outermost frame."""
        c, s = np.cos(self.phi), np.sin(self.phi)
        return vector(c * v[0] - s * v[1], s * v[0] + c * v[1])

    def point(self, x, y):
        return Point(self, self.origin + self.along((x, y)))

    def axis(self, x, y, direction):
        """The axis through (x, y); only the direction of `direction` counts."""
        return Axis(self.point(x, y), unit(self.along(direction)))


@dataclass
class Point:
    """A point of a body."""

    body: Body
    place: np.ndarray

    @property
    def arm(self):
        return self.place - self.body.origin

    @property
    def velocity(self):
        return self.body.velocity + self.body.omega * turned(self.arm)

    @property
    def acceleration(self):
        b = self.body
        return b.acceleration + b.alpha * turned(self.arm) - b.omega**2 * self.arm


@dataclass
class Axis:
    """A directed line of a body."""

    point: Point
    direction: np.ndarray

    @property
    def body(self):
        return self.point.body

    @property
    def place(self):
        return self.point.place

    @property
    def normal(self):
        """To the left of the direction."""
        return turned(self.direction)


@dataclass
class Circle:
    centre: Point
    radius: float

    @property
    def body(self):
        return self.centre.body

    def at(self, u):
        """The point of the rim at the angle u of the body's frame, with the tangent there."""
        b, c = self.body, self.centre
        return Contact(Point(b, c.place + self.radius * b.along(polar(u))), turned(b.along(polar(u))))


@dataclass
class Contact:
    """A point of a curve, and the curve's direction there."""

    point: Point
    tangent: np.ndarray

    @property
    def body(self):
        return self.point.body

    @property
    def place(self):
        return self.point.place


def contact(body, place, derivative):
    """On a curve of a body: k(u) and k'(u), both in the body's frame."""
    return Contact(body.point(*place), unit(body.along(derivative)))
