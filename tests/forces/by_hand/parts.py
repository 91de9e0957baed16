"""A crank-rocker and a feeder, alone and as parts of others: on bodies that move, mirrored too.

What a part's text says holds in the frame of its own ground, which moves with its mount: its loads act between its points and the mount.
"""

from math import cos, radians, sin

from .actions import angle, displacement, distance, rotation, scaled, shifted, x, y
from .drawings import mechanism, size
from .joints import rack_pinion, revolute, translational
from .kinematics import Axis, Circle, Point, vector


class PartGround:
    """A part's own ground: a frame on its mount. Where it is mirrored, the part's turns are the other way round from outside (`sense` = -1)."""

    def __init__(self, mount, place, phi, mirrored=False):
        self.mount, self.phi, self.sense = mount, phi, -1 if mirrored else 1
        self.origin = mount.point(*place)
        self.x = Axis(self.origin, mount.along((cos(phi), sin(phi))))
        self.y = Axis(self.origin, self.sense * mount.along((-sin(phi), cos(phi))))

    def point(self, px, py):
        return Point(self.mount, self.origin.place + px * self.x.direction + py * self.y.direction)

    def inside(self, px, py):
        """A place in a body of the part, in the frame that the body has from outside."""
        return px, self.sense * py

    def angle(self, body):
        """The part's `angle(body)`: a couple between the body and the mount."""
        return scaled(self.sense, shifted(rotation(self.mount, body), -self.phi))


class CrankRocker:
    """The bodies, joints and loads of a crank-rocker; `name` stands before their names."""

    def __init__(self, d, name, ground, coupler_length):
        at = ground.inside
        self.crank = d.body(f"{name}crank", (0.21, at(0.008, 0.005), 0.6e-4))
        self.coupler = d.body(f"{name}coupler", (0.33, at(0.037, 0.012), 1.9e-4))
        self.rocker = d.body(f"{name}rocker", (0.18, at(0.026, -0.007), 0.8e-4))
        D, self.P = ground.point(0.08, 0), self.coupler.point(*at(0.04, 0.025))

        d.joint(f"{name}main", revolute(ground.point(0, 0), self.crank.point(0, 0)))
        d.joint(f"{name}pin", revolute(self.crank.point(0.03, 0), self.coupler.point(0, 0)))
        d.joint(f"{name}knee", revolute(self.coupler.point(coupler_length, 0), self.rocker.point(0.06, 0)))
        d.joint(f"{name}pivot", revolute(D, self.rocker.point(0, 0)))

        self.main, pivot, spring = ground.angle(self.crank), ground.angle(self.rocker), distance(D, self.P)
        px, py = displacement(ground.x, self.P), displacement(ground.y, self.P)
        d.load(f"{name}pull", 2.5 + 30 * py.value, px)
        d.load(f"{name}damper", -0.015 * pivot.rate, pivot)
        d.load(f"{name}spring", -55 * (spring.value - 0.03), spring)
        d.load(f"{name}twist", 0.04 * sin(pivot.value), pivot)

        d.measure(f"{name}pin_x", lambda s: ground.x.direction @ s.reactions[f"{name}pin"][0])
        d.measure(f"{name}pin_y", lambda s: ground.y.direction @ s.reactions[f"{name}pin"][0])
        d.measure(f"{name}bearing", size(f"{name}main"))
        d.measure(f"{name}drive", lambda s: s.efforts[f"{name}motor"])


@mechanism
def crank_rocker(d):
    d.gravity = vector(0, -5)
    alone = CrankRocker(d, "", PartGround(d.ground, (0, 0), 0), 0.07)
    d.driver("motor", alone.main)


@mechanism
def turntable(d):
    d.gravity = vector(0, -9.81)
    disc = d.body("disc", (4.2, (0.013, -0.022), 0.019))
    hub = disc.point(0, 0)
    front = CrankRocker(d, "front.", PartGround(disc, (0.05, 0.02), radians(30)), 0.07)
    back = CrankRocker(d, "back.", PartGround(disc, (-0.05, 0.02), radians(150), mirrored=True), 0.075)

    d.driver("along", x(hub))
    d.driver("across", y(hub))
    d.driver("spin", angle(disc))
    d.driver("front.motor", front.main)
    d.driver("back.motor", back.main, (-1, angle(disc)))  # bound to `turn + angle(disc)`

    band, pivot = distance(front.P, back.P), shifted(rotation(disc, back.rocker), -radians(150))
    d.load("band", -40 * (band.value - 0.09), band)
    d.load("brake", -0.02 * pivot.rate, pivot)
    d.load("blow", 1.7, y(front.P))

    d.measure("front_pin_x", lambda s: s.reactions["front.pin"][0][0])
    d.measure("back_pin_y", lambda s: s.reactions["back.pin"][0][1])
    d.measure("back_drive", lambda s: s.efforts["back.motor"])


class Feeder:
    """The bodies, joints and loads of a feeder; `name` stands before their names."""

    def __init__(self, d, name, ground):
        at, s, c = ground.inside, sin(radians(15)), cos(radians(15))
        self.sled = d.body(f"{name}sled", (0.42, at(0.003, -0.006), 1.1e-4))
        pinion = d.body(f"{name}pinion", (0.13, at(-0.004, 0.002), 2.4e-5))
        self.lever = d.body(f"{name}lever", (0.27, at(0.019, -0.005), 0.9e-4))
        along = c * ground.x.direction + s * ground.y.direction
        way, rack = Axis(ground.point(0, 0), along), Axis(ground.point(-0.03 * s, 0.03 * c), along)
        sled_way, A = self.sled.axis(0, 0, (1, 0)), pinion.point(0, 0)
        self.T = self.lever.point(*at(0.045, 0.01))

        d.joint(f"{name}way", translational(way, sled_way))
        d.joint(f"{name}axle", revolute(self.sled.point(*at(0.01, 0.012)), A))
        d.joint(f"{name}teeth", rack_pinion(Circle(A, 0.018), rack, -ground.sense))
        d.joint(f"{name}hinge", revolute(self.lever.point(0, 0), self.sled.point(*at(-0.015, 0.005))))

        self.push = displacement(ground.x, self.sled.point(*at(0.02, -0.008)))
        self.tilt = ground.angle(self.lever)
        self.way, axle = displacement(way, sled_way.point), scaled(ground.sense, rotation(self.sled, pinion))
        d.load(f"{name}pull", -2.6 - 1.2 * cos(4 * d.t), displacement(ground.y, self.T))
        d.load(f"{name}rub", -0.003 * axle.rate, axle)
        d.load(f"{name}spring", -90 * (self.way.value - 0.03), self.way)

        d.measure(f"{name}teeth_x", lambda s: ground.x.direction @ s.reactions[f"{name}teeth"][0])
        d.measure(f"{name}hinge_y", lambda s: ground.y.direction @ s.reactions[f"{name}hinge"][0])
        d.measure(f"{name}tipping", lambda s: ground.sense * s.reactions[f"{name}way"][1])
        d.measure(f"{name}pushing", lambda s: s.efforts[f"{name}push"])
        d.measure(f"{name}holding", lambda s: s.efforts[f"{name}tilt"])


@mechanism
def feeder(d):
    d.gravity = vector(1, -9.5)
    alone = Feeder(d, "", PartGround(d.ground, (0, 0), 0))
    d.driver("push", alone.push)
    d.driver("tilt", alone.tilt)


@mechanism
def carousel(d):
    d.gravity = vector(0, -9.81)
    disc = d.body("disc", (2.9, (-0.007, 0.015), 8.3e-3))
    O = d.ground.point(0.02, -0.01)
    d.joint("hub", revolute(O, disc.point(0, 0)))
    hub = rotation(d.ground, disc)
    d.driver("motor", hub)

    front = Feeder(d, "front.", PartGround(disc, (0.07, 0.01), radians(40)))
    d.driver("front.push", front.push)
    d.driver("front.tilt", front.tilt)

    back = Feeder(d, "back.", PartGround(front.lever, (0.03, -0.005), radians(-70), mirrored=True))
    d.driver("back.push", back.push, (-0.3, front.way))  # bound to `50 mm + 0.3 * displacement(front.way)`
    d.driver("back.tilt", back.tilt, (0.5, angle(disc)))  # bound to `20 deg - angle(disc) / 2`

    band = distance(O, back.T)
    d.load("brake", -0.05 * hub.rate, hub)
    d.load("band", -35 * (band.value - 0.08), band)

    d.measure("teeth_x_outside", lambda s: s.reactions["back.teeth"][0][0])
    d.measure("tipping_outside", lambda s: s.reactions["back.way"][1])
