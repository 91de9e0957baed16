"""What acts on bodies: forces with their places, couples, and the pairs of them that work on one kinematic quantity.

An `Action` is what one unknown (a component of a reaction, an effort) or one load of size 1 does: a push on each body that it reaches. What
acts between two bodies is equal and opposite, and at one place.
"""

from dataclasses import dataclass

import numpy as np

from .kinematics import Body, cross, turned, vector


@dataclass
class Push:
    """A force at a place of the outermost frame, and a couple."""

    body: Body
    place: np.ndarray
    force: np.ndarray
    couple: float = 0.0

    def moment(self, about):
        return cross(self.place - about, self.force) + self.couple


Action = list[Push]


def force_between(first, second, place, force):
    """A force on `second` at the place, and its reaction on `first`."""
    return [Push(second, place, force), Push(first, place, -force)]


def couple_between(first, second, size=1.0):
    nothing = vector(0, 0)
    return [Push(second, second.origin, nothing, size), Push(first, first.origin, nothing, -size)]


@dataclass
class Quantity:
    """A kinematic quantity K: its value and rate, and what a generalized force of 1 on it is: forces and couples whose power is dK/dt."""

    value: float
    rate: float
    action: Action


def x(point):
    return along(vector(1, 0), point)


def y(point):
    return along(vector(0, 1), point)


def along(direction, point):
    """The place of a point in a direction that stands still: a force in that direction."""
    return Quantity(direction @ point.place, direction @ point.velocity, [Push(point.body, point.place, direction)])


def scaled(factor, k):
    """`factor * k`."""
    return Quantity(factor * k.value, factor * k.rate, scaled_action(factor, k.action))


def shifted(k, constant):
    """`k + constant`."""
    return Quantity(k.value + constant, k.rate, k.action)


def difference(of, from_):
    """`of - from_`: a push on the one, the opposite on the other."""
    return Quantity(of.value - from_.value, of.rate - from_.rate, of.action + scaled_action(-1, from_.action))


def scaled_action(factor, action):
    return [Push(p.body, p.place, factor * p.force, factor * p.couple) for p in action]


def angle(body):
    return Quantity(body.phi, body.omega, [Push(body, body.origin, vector(0, 0), 1.0)])


def rotation(first, second):
    """The angle from the first body to the second: a couple between them."""
    return Quantity(second.phi - first.phi, second.omega - first.omega, couple_between(first, second))


def distance(first, second):
    """A force of 1 drives the points apart, along the line between them."""
    d, rate = second.place - first.place, second.velocity - first.velocity
    length = np.hypot(*d)
    e = d / length
    return Quantity(length, e @ rate, [Push(second.body, second.place, e), Push(first.body, first.place, -e)])


def displacement(axis, point):
    """How far a point is along an axis of another body: a force along the axis, where the point is."""
    d = point.place - axis.place
    seen = point.velocity - axis.point.velocity - axis.body.omega * turned(d)
    push = force_between(axis.body, point.body, point.place, axis.direction)
    return Quantity(axis.direction @ d, axis.direction @ seen, push)
