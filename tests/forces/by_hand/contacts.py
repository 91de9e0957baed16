"""Gears, racks, cams and followers."""

from math import cos, pi, radians, sin, sqrt

from .actions import angle, displacement, distance, rotation, x, y
from .drawings import GRAVITY, INCH, POUND, mechanism, power, size
from .joints import (
    cam,
    flat_follower,
    gear,
    internal_gear,
    point_follower,
    rack_pinion,
    revolute,
    revolute_translational,
    translational,
)
from .kinematics import Circle, contact, vector


@mechanism
def gear_ground(d):
    d.gravity = vector(0, -9.81)
    R, S, T = 0.4, 0.15, 0.1
    arm = d.body("arm", (5.3, (0.31, 0.07), 0.42))
    planet = d.body("planet", (2.6, (0.02, 0.05), 0.034))
    last = d.body("last", (1.7, (-0.03, 0.01), 0.009))
    O, P, Q = d.ground.point(-0.3, 0.7), planet.point(0, 0), last.point(0, 0)
    arm_q = arm.point(R + S + (S + T) / 2, (S + T) * sqrt(3) / 2)
    sun, planet_pitch, last_pitch = Circle(O, R), Circle(P, S), Circle(Q, T)

    d.joint("hub", revolute(O, arm.point(0, 0)))
    d.joint("p", revolute(arm.point(R + S, 0), P))
    d.joint("q", revolute(Q, arm_q))
    d.joint("fix", gear(sun, planet_pitch))
    d.joint("mesh", gear(last_pitch, planet_pitch))

    d.driver("motor", angle(arm))

    between = rotation(planet, last)
    d.load("rub", -0.8 * between.rate, between)
    d.load("pull", 27 * sin(3 * d.t), y(planet.point(0, -S)))
    d.load("work", -3.1 - 1.9 * cos(last.phi), angle(last))

    d.measure("teeth", size("mesh"))
    d.measure("power", power("motor", arm.omega))


@mechanism
def internal_small_first(d):
    d.gravity = vector(0, -9.81)
    pound_inch2, pound_force = POUND * INCH**2, POUND * GRAVITY
    pinion = d.body("pinion", (1.2 * POUND, (0.3 * INCH, -0.1 * INCH), 2.9 * pound_inch2))
    ring = d.body("ring", (6.5 * POUND, (-0.4 * INCH, 0.2 * INCH), 150 * pound_inch2))
    other = d.body("other", (2.1 * POUND, (0.2 * INCH, 0.6 * INCH), 6.3 * pound_inch2))
    rx, ry = 12 - 3 * cos(radians(35)), 2 - 3 * sin(radians(35))
    A, R, B, N = (d.ground.point(px * INCH, py * INCH) for px, py in ((12, 2), (rx, ry), (rx + 2.5, ry), (12, -7)))
    pinion_a, ring_r, other_b = pinion.point(0, 0), ring.point(0, 0), other.point(-0.5 * INCH, 0.2 * INCH)
    lug = ring.point(5.5 * INCH, INCH)
    rim = Circle(ring_r, 5 * INCH)

    d.joint("a", revolute(A, pinion_a))
    d.joint("r", revolute(ring_r, R))
    d.joint("b", revolute(B, other_b))
    d.joint("mesh", internal_gear(Circle(pinion_a, 2 * INCH), rim))
    d.joint("mesh2", internal_gear(rim, Circle(other_b, 2.5 * INCH)))

    d.driver("motor", rotation(d.ground, pinion))

    r, spring = rotation(ring, d.ground), distance(N, lug)
    d.load("brake", -1.4 * pound_force * 12 * INCH * r.rate, r)
    d.load("spring", -2.5 * pound_force / INCH * (spring.value - 4 * INCH), spring)
    d.load("drill", -0.6 - 0.25 * cos(other.phi), angle(other))

    d.measure("teeth", lambda s: size("mesh2")(s) / pound_force)


@mechanism
def cardan(d):
    d.gravity = vector(0, -9.81)
    R = 0.5
    arm = d.body("arm", (3.3, (0.14, -0.03), 0.06))
    planet = d.body("planet", (2.1, (0.05, 0.09), 0.047))
    O, P, pen = d.ground.point(0.2, 0.1), planet.point(0, 0), planet.point(R / 2, 0)

    d.joint("o", revolute(O, arm.point(0, 0)))
    d.joint("p", revolute(P, arm.point(R / 2, 0)))
    d.joint("roll", internal_gear(Circle(P, R / 2), Circle(O, R)))

    d.driver("run", angle(arm))

    spring, p = distance(O, pen), rotation(planet, arm)
    d.load("work", -12 - 25 * (pen.place[0] - 0.2) - 6 * pen.velocity[0], x(pen))
    d.load("spring", -85 * (spring.value - 0.2), spring)
    d.load("rub", -0.15 * p.rate, p)

    d.measure("teeth", size("roll"))
    d.measure("power", power("run", arm.omega))


@mechanism
def rack_moving(d):
    d.gravity = vector(0.4, -9.79)
    rack = d.body("rack", (1.9, (0.031, 0.024), 3.6e-3))
    carriage = d.body("carriage", (0.55, (0.007, -0.004), 1.7e-4))
    pinion = d.body("pinion", (0.34, (0.003, 0.005), 0.9e-4))
    O, pin = rack.point(0, 0), pinion.point(0, 0)
    rail, way = rack.axis(0.06, 0, (-3, -4)), carriage.axis(0, 0, (0, -1))

    d.joint("guide", translational(rail, way))
    d.joint("pin", revolute(carriage.point(-0.005, 0.015), pin))
    d.joint("teeth", rack_pinion(Circle(pin, 0.021), rack.axis(0.02, -0.01, (3, 4)), -1))

    guide, spin = displacement(rail, way.point), rotation(rack, pinion)
    d.driver("rx", x(O))
    d.driver("ry", y(O))
    d.driver("turn", angle(rack))
    d.driver("feed", guide)

    d.load("spring", -210 * (guide.value - 0.035), guide)
    d.load("damper", -12 * guide.rate, guide)
    d.load("spin", -0.04 - 0.013 * spin.rate, spin)
    d.load("blow", 5.5, x(pin))

    d.measure("pitch_force", size("teeth"))
    d.measure("power", power("feed", guide.rate))


@mechanism
def rack_drawn(d):
    d.gravity = vector(0, -9.81)
    pinion = d.body("pinion", (0.83, (0.006, -0.011), 3.3e-4))
    bar = d.body("bar", (0.26, (0.025, 0.009), 0))
    slope = radians(-20)
    rack, line = d.ground.axis(0.01, 0.005, (cos(slope), sin(slope))), bar.axis(-0.02, 0.005, (1, 0))
    C, N = d.ground.point(0.3, 0.1), d.ground.point(0.2, 0.3)
    M, pen = pinion.point(0.003, 0), bar.point(0.04, 0.005)

    d.joint("teeth", rack_pinion(Circle(M, 0.03), rack, -1))
    d.joint("side", revolute_translational(M, rack, -0.03))
    d.joint("roll", rack_pinion(Circle(C, 0.08), line, +1))
    d.joint("touch", revolute_translational(C, line, 0.08))

    d.driver("motor", x(M))
    d.driver("sway", angle(bar))

    spring = distance(N, pen)
    d.load("drag", -6 * M.velocity[0], x(M))
    d.load("spring", -130 * (spring.value - 0.06), spring)
    d.load("twist", -0.3 * cos(pinion.phi), angle(pinion))


@mechanism
def cam_roller(d):
    d.gravity = vector(0, -9.81)
    plate = d.body("plate", (1.1, (0.8 * INCH, -0.15 * INCH), 1.4e-3))
    arm = d.body("arm", (0.48, (1.7 * INCH, 0.3 * INCH), 3.1e-4))
    O, V = d.ground.point(0, INCH), d.ground.point(4 * INCH, INCH)
    roller = Circle(arm.point(3 * INCH, -0.2 * INCH), 0.4 * INCH)
    u, w = d.cells["contact.u"], d.cells["contact.w"]
    lobe, slope = (2 + 0.2 * cos(3 * w)) * INCH, -0.6 * sin(3 * w) * INCH
    k = contact(
        plate,
        (0.5 * INCH + lobe * cos(w), lobe * sin(w)),
        (slope * cos(w) - lobe * sin(w), slope * sin(w) + lobe * cos(w)),
    )

    d.joint("main", revolute(plate.point(0.5 * INCH, 0), O))
    d.joint("pivot", revolute(arm.point(0, 0), V))
    d.joint("contact", cam(roller.at(u), k))

    main, pivot = rotation(plate, d.ground), rotation(arm, d.ground)
    d.driver("motor", main)

    d.load("spring", 2.4 * (-pi - pivot.value), pivot)
    d.load("damper", -0.03 * pivot.rate, pivot)
    d.load("lubber", -0.12 - 0.05 * cos(2 * main.value), main)

    d.measure("press", size("contact"))
    d.measure("power", power("motor", main.rate))


@mechanism
def flat_disc(d):
    d.gravity = vector(0, -9.81)
    disc = d.body("disc", (0.37, (-0.002, 0.007), 0.95e-4))
    tappet = d.body("tappet", (0.22, (0.004, 0.016), 0.6e-4))
    egg = d.body("egg", (0.71, (0.005, -0.003), 2.5e-4))
    way, floor = d.ground.axis(0, 0.05, (-1, 4)), d.ground.axis(0.2, -0.01, (0.1, 0.02))
    tappet_way = tappet.axis(0, 0, (0, 1))
    face = tappet.axis(0, -0.003, (cos(radians(12)), sin(radians(12))))
    M = egg.point(0, 0)
    u = d.cells["floor.u"]
    k = contact(egg, (0.03 * cos(u), 0.02 * sin(u)), (-0.03 * sin(u), 0.02 * cos(u)))

    d.joint("main", revolute(d.ground.point(0.015, -0.005), disc.point(0, 0)))
    d.joint("guide", translational(way, tappet_way))
    d.joint("face", flat_follower(Circle(disc.point(0, 0.008), 0.022).at(d.cells["face.u"]), face))
    d.joint("floor", flat_follower(k, floor))

    main, guide = rotation(d.ground, disc), displacement(way, tappet_way.point)
    d.driver("motor", main)
    d.driver("roll", angle(egg))
    d.driver("slip", x(M))

    d.load("spring", -38 - 950 * guide.value, guide)
    d.load("damper", -7 * guide.rate, guide)
    d.load("rub", -0.02 * main.rate, main)
    d.load("press", -16 + 4 * sin(2 * pi * d.t), y(M))

    d.measure("side", lambda s: s.reactions["guide"][1])


@mechanism
def pf_moving(d):
    d.gravity = vector(0, -9.81)
    crank = d.body("crank")
    rod = d.body("rod", (0.16, (0.009, 0.014), 0.55e-4))
    rocker = d.body("rocker", (0.047, (0.014, -0.003), 0.6e-5))
    slider = d.body("slider", (0.085, (0.011, 0.004), 1.3e-5))
    pole = d.body("pole", (0.068, (-0.006, 0.005), 0.9e-5))
    rod_d, N = rod.point(0.038, 0), d.ground.point(0.02, 0.12)
    way, up = d.ground.axis(-0.01, 0.09, (1, 5)), d.ground.axis(-0.036, 0, (1, 10))
    slider_way, pole_up = slider.axis(0, 0, (1, 0)), pole.axis(0.005, 0, (1, 0))
    v = d.cells["run.u"]
    hill = contact(rod, (0.015 + 0.01 * v, 0.04 - 0.006 * v**2 + 0.0015 * v**3), (0.01, -0.012 * v + 0.0045 * v**2))
    eye = Circle(rod.point(-0.02, 0.01), 0.022)

    d.joint("main", revolute(d.ground.point(-0.01, 0.02), crank.point(0, 0)))
    d.joint("pin", revolute(crank.point(0.012, 0), rod.point(0, 0)))
    d.joint("knee", revolute(rod_d, rocker.point(0.03, 0)))
    d.joint("pivot", revolute(rocker.point(0, 0), d.ground.point(0.03, 0.02)))
    d.joint("guide", translational(way, slider_way))
    d.joint("run", point_follower(slider.point(0, -0.002), hill))
    d.joint("guide2", translational(pole_up, up))
    d.joint("run2", point_follower(pole.point(0.01, -0.003), eye.at(d.cells["run2.u"])))

    main = rotation(d.ground, crank)
    d.driver("motor", main)

    guide, guide2 = displacement(way, slider_way.point), displacement(pole_up, up.point)
    band, knee = distance(N, rod_d), rotation(rod, rocker)
    d.load("spring", -3.5 - 45 * guide.value, guide)
    d.load("spring2", 3.5 - 60 * (guide2.value + 0.06), guide2)
    d.load("band", -25 * (band.value - 0.05), band)
    d.load("rub", -0.002 * knee.rate, knee)

    d.measure("press", size("run"))
    d.measure("press2", size("run2"))
    d.measure("power", power("motor", main.rate))


@mechanism
def pf_ellipse(d):
    d.gravity = vector(0, -9.81)
    a, b = 0.09, 0.05
    lever = d.body("lever", (0.9, (0.045, 0.013), 1.6e-3))
    pen = d.body("pen", (0.24, (0.009, 0.011), 0))
    O, P, top = d.ground.point(0.1, -0.2), pen.point(0.005, -0.005), pen.point(0.005, 0.015)
    u, c, s = d.cells["run.u"], cos(pi / 6), sin(pi / 6)
    path = contact(
        d.ground,
        (0.1 + a * cos(u) * c - b * sin(u) * s, -0.2 + a * cos(u) * s + b * sin(u) * c),
        (-a * sin(u) * c - b * cos(u) * s, -a * sin(u) * s + b * cos(u) * c),
    )

    d.joint("main", revolute(O, lever.point(0, 0)))
    d.joint("block", revolute_translational(P, lever.axis(0, 0.01, (1, 0)), -0.01))
    d.joint("run", point_follower(P, path))

    main, band = rotation(d.ground, lever), distance(top, O)
    d.driver("motor", main)
    d.driver("hold", rotation(lever, pen))

    d.load("band", -300 * (band.value - 0.04), band)
    d.load("rub", -0.006 * main.rate, main)
    d.load("draw", 3 - 8 * top.velocity[1], y(top))

    d.measure("press", size("run"))


@mechanism
def cam_inner(d):
    d.gravity = vector(0, -9.81)
    disc = d.body("disc", (31, (0.16, -0.04), 0.8))
    O, C, T = d.ground.point(-1, 0.5), disc.point(0.1, 0), disc.point(0.1, 0.25)

    d.joint("contact", cam(Circle(C, 0.25).at(d.cells["contact.u"]), Circle(O, 0.8).at(d.cells["contact.w"])))

    d.driver("push", x(C))
    d.driver("turn", angle(disc))

    spring = distance(O, T)
    d.load("spring", -70 * (spring.value - 1.5), spring)
    d.load("rub", -2.2 * disc.omega, angle(disc))

    d.measure("press", size("contact"))
