"""Linkages, and bodies that equations alone hold: pins, ways, slots, welds, struts."""

from math import cos, hypot, pi, radians, sin, sqrt

from .actions import angle, difference, displacement, distance, rotation, x, y
from .drawings import INCH, mechanism, power, size, step5
from .joints import revolute, revolute_revolute, revolute_translational, translational, weld
from .kinematics import vector


@mechanism
def ground_second(d):
    d.gravity = vector(1.3, -9.7)
    crank = d.body("crank", (0.62, (0.017, -0.009), 4.3e-4))
    rod = d.body("rod", (0.41, (0.052, 0.006), 5.9e-4))
    slider = d.body("slider", (1.35, (0.008, 0.011), 9.1e-4))
    plate = d.body("plate", (0.28, (0.035, -0.012), 2.2e-4))
    lid = d.body("lid", (0.19, (0.013, 0.021), 0.8e-4))
    ground = d.ground
    stud, rim = ground.point(0.09, 0.06), ground.point(0.06, 0.04)
    wrist, hook, edge = slider.point(0, 0), rod.point(0.048, -0.014), lid.point(-0.01, 0.005)
    ground_way = ground.axis(0, -0.02, (-1, 0))

    d.joint("main", revolute(crank.point(0, 0), ground.point(0, 0)))
    d.joint("big", revolute(rod.point(0, 0), crank.point(0.06, 0)))
    d.joint("small", revolute(wrist, rod.point(0.11, 0)))
    d.joint("guide", translational(slider.axis(0.005, 0, (1, 0)), ground_way))
    d.joint("eye", revolute(plate.point(0, 0), wrist))
    d.joint("block", revolute_translational(stud, plate.axis(-0.01, 0, (1, 0)), 0.004))
    d.joint("seam", weld(edge, rim, pi / 6))

    guide = displacement(slider.axis(0.005, 0, (1, 0)), ground_way.point)
    d.driver("push", guide)

    main, band = rotation(crank, ground), distance(rim, hook)
    d.load("brake", -0.35 * main.rate, main)
    d.load("resist", 14 - 60 * guide.rate, guide)
    d.load("hang", -23, y(hook))
    d.load("blow", 9 * sin(7 * d.t), x(edge))
    d.load("band", -180 * (band.value - 0.03), band)

    d.measure("bearing", size("main"))
    d.measure("power", power("push", guide.rate))


@mechanism
def revolute_offsets(d):
    d.gravity = vector(0, -9.81)
    arm = d.body("arm", (3.7, (0.12, 0.09), 0.31), (0.9, (-0.25, -0.14), 0))
    plate = d.body("plate", (1.45, (0.06, 0.11), 0.043))
    rocker = d.body("rocker", (2.2, (0.21, -0.05), 0.077))
    O, Q = d.ground.point(0, 0), d.ground.point(1.5, 0.2)
    P, S = plate.point(0.2, 0.1), rocker.point(0.5, 0)

    d.joint("main", revolute(O, arm.point(-0.4, 0)))
    d.joint("seam", weld(arm.point(0.6, 0.3), plate.point(-0.1, 0.05), radians(35)))
    d.joint("pivot", revolute(Q, rocker.point(0, 0)))
    d.joint("strut", revolute_revolute(P, S, 0.85))

    d.driver("motor", rotation(d.ground, arm))  # the axes' angles in their bodies change nothing that works

    pivot, spring = rotation(d.ground, rocker), distance(O, S)
    d.load("crush", -6 - 11 * sin(2 * pivot.value) ** 2, pivot)
    d.load("damper", -4.2 * pivot.rate, pivot)
    d.load("spring", -95 * (spring.value - 1.1), spring)
    d.load("shake", 31 * cos(2.6 * d.t), x(P))

    d.measure("thrust", size("strut"))


@mechanism
def slots(d):
    d.gravity = vector(0, -9.81)
    crank = d.body("crank", (1.5, (0.022, -0.008), 2.1e-3))
    lever = d.body("lever", (0.92, (0.13, 0.017), 7.7e-3))
    block = d.body("block", (0.31, (0.006, -0.009), 1.2e-4))
    plate = d.body("plate", (0.44, (-0.014, 0.019), 3.8e-4))
    rail, bore = lever.axis(0.04, 0, (1, 2)), block.axis(0, 0, (0, 1))
    foot = plate.point(0.005, -0.02)

    d.joint("main", revolute(d.ground.point(0, 0), crank.point(0, 0)))
    d.joint("pivot", revolute(d.ground.point(12 * INCH, 0), lever.point(0, 0)))
    d.joint("one", revolute_translational(crank.point(3 * INCH, 0), lever.axis(0, 0.01, (1, 0)), -0.5 * INCH))
    d.joint("slide", translational(rail, bore))
    d.joint("two", revolute_translational(block.point(0.02, 0.01), d.ground.axis(0, 0.2, (-1, 0.2)), 0.003))
    d.joint("seam", weld(crank.point(INCH, 0), foot, -pi / 3))

    main, pivot, slide = rotation(d.ground, crank), rotation(d.ground, lever), displacement(rail, bore.point)
    d.driver("motor", main)

    d.load("spring", -160 * (slide.value - 0.09), slide)
    d.load("oil", -9 * slide.rate, slide)
    d.load("cut", -1.1 - 0.7 * sin(pivot.value), pivot)
    d.load("weight", -6, y(foot))

    d.measure("pinch", size("one"))
    d.measure("power", power("motor", main.rate))


@mechanism
def coupler_constraint(d):
    d.gravity = vector(0, -9.81)
    focal = 0.5
    left = d.body("left", (1.8, (0.11, 0.04), 0.024))
    right = d.body("right", (2.7, (-0.09, 0.17), 0.061))
    link = d.body("link", (1.25, (0.38, -0.06), 0.092))
    pin, end, tip = left.point(0.3, 0), right.point(-0.2, 0.35), link.point(0.9, 0)

    d.joint("A", revolute(d.ground.point(0, 0), left.point(0, 0)))
    d.joint("B", revolute(right.point(0, 0), d.ground.point(1.5, 0)))
    d.joint("pin", revolute(pin, link.point(0, 0)))

    A, B = rotation(d.ground, left), rotation(right, d.ground)
    d.driver("ratio", A, (-2, B))
    d.driver("path", y(tip), (-tip.place[0] / focal, x(tip)))
    d.driver("motor", B)

    spring, rub = distance(pin, end), rotation(left, link)
    d.load("spring", -75 * (spring.value - 0.8), spring)
    d.load("wind", -8 - 5 * cos(4 * d.t), x(tip))
    d.load("rub", -0.6 * rub.rate, rub)

    d.measure("press", lambda s: s.efforts["path"])
    d.measure("power", power("motor", B.rate))


@mechanism
def digger(d):
    d.gravity = vector(0, -9.81)
    house = d.body("house", (7200, (-0.6, 1.1), 5900))
    boom = d.body("boom", (1150, (2.4, 0.2), 2300))
    arm = d.body("arm", (640, (0.9, 0.05), 480), (310, (2.2, -0.15), 0))
    track, house_track = d.ground.axis(0, 0, (1, 0)), house.axis(0, 0, (1, 0))
    tooth = arm.point(2.6, -0.2)

    d.joint("tracks", translational(track, house_track))
    d.joint("heel", revolute(house.point(0.5, 1.2), boom.point(0, 0)))
    d.joint("elbow", revolute(boom.point(5, 0), arm.point(0, 0)))

    tracks = displacement(track, house_track.point)
    lift = distance(house.point(1.0, 0.7), boom.point(2.2, 0.35))
    d.driver("travel", tracks)
    d.driver("lift", lift)
    d.driver("crowd", distance(boom.point(2.6, 0.5), arm.point(-0.6, 0.25)))

    d.load("dig", step5(d.t, 0.7, 0, 3.2, 14e3), x(tooth))
    d.load("cut", 3e3 * sin(2 * d.t), y(tooth))
    d.load("roll", -900 - 2500 * tracks.rate, tracks)
    d.load("valve", -18e3 * lift.rate, lift)

    d.measure("lift_power", lambda s: s.efforts["lift"] * lift.rate / 1e3)
    d.measure("heel_load", lambda s: size("heel")(s) / 1e3)
    d.measure("tilt", lambda s: s.reactions["tracks"][1])


@mechanism
def equations(d):
    d.gravity = vector(0, -9.81)
    arm = d.body("arm", (2.3, (0.36, 0.07), 0.14))
    plate = d.body("plate", (1.1, (0.21, -0.06), 0.033))
    bar = d.body("bar", (0.7, (0.26, 0.03), 0.025))
    pin, tip, H, K = arm.point(0.8, 0), plate.point(0.5, 0.1), bar.point(0, 0), bar.point(0.6, 0)

    d.joint("root", revolute(d.ground.point(0, 0), arm.point(0, 0)))
    d.joint("hand", revolute(pin, plate.point(0, 0)))

    root, hand = rotation(d.ground, arm), rotation(arm, plate)
    d.driver("wave", y(tip), (0.6 * cos(3 * tip.place[0]), x(tip)))
    d.driver("ellipse", (1 / 2, distance(tip, H)), distance(H, d.ground.point(2, 1)))
    kx, ky = K.place[0], K.place[1] - 0.2
    d.driver("reach", (0.1, hand), (-kx / hypot(kx, ky), x(K)), (-ky / hypot(kx, ky), y(K)))
    # sqrt(|a|) for a > 0 changes by 1 / (2 sqrt(a)); atan2(dy, dx) by (dx δdy - dy δdx) / (dx^2 + dy^2)
    (dx, dy), a = K.place - H.place, root.value
    d.driver(
        "heading",
        (dx / (dx**2 + dy**2), difference(y(K), y(H))),
        (-dy / (dx**2 + dy**2), difference(x(K), x(H))),
        (0.5 / (2 * sqrt(a)), root),
    )
    d.driver("motor", (1 + 0.2 * cos(2 * a), root), (-0.02 * d.t, y(tip)))

    stay = distance(pin, K)
    d.load("stay", -40 * (stay.value - 0.9), stay)
    d.load("drag", -1.6 * root.rate, root)
    d.load("twist", 2 * cos(3 * d.t), rotation(plate, bar))


@mechanism
def relative_xy(d):
    d.gravity = vector(0.7, -9.8)
    a = d.body("a", (1.9, (0.04, -0.07), 0.021))
    b = d.body("b", (1.2, (0.03, 0.08), 0.015))
    P, Q = a.point(0.1, 0.05), b.point(-0.2, 0.15)
    rx, ry = difference(x(Q), x(P)), difference(y(Q), y(P))

    d.driver("ax", x(P))
    d.driver("ay", y(P))
    d.driver("aturn", angle(a))
    d.driver("rx", rx)
    d.driver("ry", ry)
    d.driver("rturn", rotation(a, b))

    spring = distance(P, Q)
    d.load("spring", -60 * (spring.value - 0.3), spring)
    d.load("drag", -4 * rx.rate, rx)
    d.load("heave", 3 - 20 * Q.place[1], y(Q))

    d.measure("power", lambda s: s.efforts["rx"] * rx.rate + s.efforts["ry"] * ry.rate)


@mechanism
def three_rpr(d):
    d.gravity = vector(0, -9.81)
    platform = d.body("platform", (14, (0.04, -0.07), 0.9), (5, (0, 0.35), 0))
    P1, P2, P3 = platform.point(-0.3, -0.2), platform.point(0.3, -0.2), platform.point(0, 0.35)
    B1, B2, B3 = d.ground.point(0, 0), d.ground.point(2, 0), d.ground.point(1, 1.7)

    leg1 = distance(P1, B1)
    d.driver("leg1", leg1)
    d.driver("leg2", (-1, distance(P2, B2)))  # the distance is on the right
    d.driver("leg3", distance(P3, B3))

    spring, oil = distance(P1, B2), distance(P3, B1)
    d.load("spring", -110 * (spring.value - 1.4), spring)
    d.load("oil", -65 * oil.rate, oil)
    d.load("twist", 9 * sin(2 * d.t), angle(platform))

    d.measure("power1", power("leg1", leg1.rate))
