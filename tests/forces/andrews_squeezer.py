"""Andrews' squeezing mechanism under its published constant torque: its motion, and what its joints transmit.

andrews_squeezer.py [--check]

Writes `andrews_squeezer_motion.csv`, the crank's angle in time, which the text reads, and `andrews_squeezer.csv`, the reactions of the published motion;
with --check nothing is written, and the published numbers are compared with those of this computation. README.md explains both. Needs mpmath; no mechc.

Data, start and solution are those of `andrews.f` in the Test Set for Initial Value Problem Solvers; the mechanism is described in W. Schiehlen (ed.), Multibody
Systems Handbook, 1990, and in E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, VII.7. Points, velocities and forces are complex numbers here.
"""

import csv
import sys
from dataclasses import dataclass
from pathlib import Path

from mpmath import arg, cos, exp, matrix, mp, mpc, mpf, nstr, pi, polyval, sqrt

mp.dps = 34
FOLDER = Path(__file__).parent

RR, DD, SS, EE, ZT, ZF, UU = map(mpf, ["0.007", "0.028", "0.035", "0.02", "0.04", "0.02", "0.04"])
A, B, C = mpc("-0.06934", "-0.00227"), mpc("-0.03635", "0.03273"), mpc("0.014", "0.072")
MASSES = list(map(mpf, ["0.04325", "0.00365", "0.02373", "0.00706", "0.0705", "0.00706", "0.05498"]))
INERTIAS = list(map(mpf, ["2.194e-6", "4.41e-7", "5.255e-6", "5.667e-7", "1.169e-5", "5.667e-7", "1.912e-5"]))
# in the frames of the text
CENTRES = [
    mpc("0.00092", 0),  # ra
    mpc("-0.0115", 0),  # da
    mpc("0.01043", "-0.01874"),  # sb, sa
    mpc(0, "-0.00579"),  # e - ea
    mpc("0.02308", "0.00916"),  # ta, tb
    mpc("0.00579", 0),  # zf - fa
    mpc("-0.00449", "-0.01228"),  # ub, ua
]
HOOK = mpc("0.02", "-0.018")  # of the spring on K3: sd, sc
STIFFNESS, FREE_LENGTH, TORQUE = mpf(4530), mpf("0.07785"), mpf("0.033")
START = mpf("-0.0617138900142764496358948458001")

# at the end, which is the Test Set's y(1) to y(27): angles, their rates, those of these, the forces at E on K3, K4 and K6
ANGLES = "beta Theta gamma Phi delta Omega epsilon".split()
QUANTITIES = [*ANGLES, *(f"{a}.d" for a in ANGLES), *(f"{a}.dd" for a in ANGLES), "J3.fx", "J3.fy", "J4.fx", "J4.fy", "J5.fx", "J5.fy"]
PUBLISHED_NUMBERS = """15.81077119629904 -15.75637105984298 0.04082224013073101 -0.5347301163226948 0.5244099658805304 0.5347301163226948 1.048080741042263
    1139.920302151208 -1424.379294994111 11.03291221937134 19.29337464421385 0.5735699284790808 -19.29337464421385 0.3231791658026955
    -24631.76316945196 51850.37701610329 324102.5686413781 566749.3645176213 16743.62929479361 -566749.3645176222 9826.520791458422
    199.1753333731910 -29.75531228015052 23.06654119098399 31.45271365475927 22.64249232082739 11.61740700019673"""
PUBLISHED_END = dict(zip(QUANTITIES, map(mpf, PUBLISHED_NUMBERS.split())))
PUBLISHED_START = {
    "beta.dd": mpf("14222.4439199541138705911625887"),
    "J3.fx": mpf("98.5668703962410896057654982170"),
    "J3.fy": mpf("-6.12268834425566265503114393122"),
}

END, ROWS = mpf("0.03"), 50  # a row at the start too
STEP = mpf("8e-6")  # from one point of a table to the next
MARGIN = 30  # points beyond either end: that the table's second derivative vanishes at its own ends is felt 0.27^30 there


def dot(a, b):
    return a.real * b.real + a.imag * b.imag


def cross(a, b):
    return a.real * b.imag - a.imag * b.real


@dataclass
class Point:
    place: mpc
    velocity: mpc = mpc(0)
    acceleration: mpc = mpc(0)


@dataclass
class Body:
    """A frame: its origin, its direction as a number of size 1, its angular velocity and acceleration."""

    origin: Point
    direction: mpc
    omega: mpf
    alpha: mpf

    def point(self, place):
        o, r = self.origin, self.direction * place
        return Point(o.place + r, o.velocity + 1j * self.omega * r, o.acceleration + (1j * self.alpha - self.omega**2) * r)


def dyad(p, length_p, q, length_q):
    """Two rods from p and q to a common pin, to the left of the way from p to q: (rod, its angular velocity and acceleration) of either."""
    d = q.place - p.place
    along = (dot(d, d) + length_p**2 - length_q**2) / (2 * abs(d))
    rod_p = d / abs(d) * mpc(along, sqrt(length_p**2 - along**2))
    rod_q = rod_p - d
    turned = cross(rod_p, rod_q)

    def rates(gap):  # of rod_p i w_p - rod_q i w_q = gap
        return dot(gap, rod_q) / turned, dot(gap, rod_p) / turned

    omega_p, omega_q = rates(q.velocity - p.velocity)
    alpha_p, alpha_q = rates(q.acceleration - p.acceleration + omega_p**2 * rod_p - omega_q**2 * rod_q)
    return (rod_p, omega_p, alpha_p), (rod_q, omega_q, alpha_q)


def bodies(beta, omega, alpha):
    """K1 to K7, with the frames of the text, for the crank's angle and its rates."""
    k1 = Body(Point(mpc(0)), exp(1j * beta), omega, alpha)
    F = k1.point(RR)
    FE, BE = dyad(F, DD, Point(B), SS)
    k2, k3 = Body(F, -FE[0] / DD, *FE[1:]), Body(Point(B), 1j * BE[0] / SS, *BE[1:])
    E = k2.point(-DD)
    AG, EG = dyad(Point(A), ZT, E, EE)
    k5 = Body(Point(A), AG[0] / ZT, *AG[1:])
    k4 = Body(k5.point(ZT), -1j * EG[0] / EE, *EG[1:])
    EH, AH = dyad(E, ZF, Point(A), UU)
    k7 = Body(Point(A), 1j * AH[0] / UU, *AH[1:])
    k6 = Body(k7.point(-1j * UU), -EH[0] / ZF, *EH[1:])
    return [k1, k2, k3, k4, k5, k6, k7]


def centres(all_bodies):
    return [body.point(centre) for body, centre in zip(all_bodies, CENTRES)]


def spring(k3):
    """Where the spring holds K3, and its force there."""
    hook = k3.point(HOOK)
    d = hook.place - C
    return hook, -STIFFNESS * (abs(d) - FREE_LENGTH) * d / abs(d)


def stored(k3):
    return STIFFNESS / 2 * (abs(k3.point(HOOK).place - C) - FREE_LENGTH) ** 2


def twice_kinetic(all_bodies):
    linear = sum(m * dot(c.velocity, c.velocity) for m, c in zip(MASSES, centres(all_bodies)))
    return linear + sum(i * body.omega**2 for i, body in zip(INERTIAS, all_bodies))


def speed(beta):
    """The crank's angular velocity: what the torque has done since the start, less what the spring holds, is kinetic energy."""
    unit = bodies(beta, mpf(1), mpf(0))
    return sqrt(2 * (TORQUE * (beta - START) - stored(unit[2]) + AT_START) / twice_kinetic(unit))


def acceleration(beta, omega):
    """The crank's angular acceleration, by the power of all that acts, inertia forces included."""
    unit, coasting = bodies(beta, mpf(1), mpf(0)), bodies(beta, omega, mpf(0))
    hook, force = spring(unit[2])
    power = TORQUE + dot(force, hook.velocity)
    for m, i, u, cu, k, c in zip(MASSES, INERTIAS, unit, centres(unit), coasting, centres(coasting)):
        power -= m * dot(c.acceleration, cu.velocity) + i * k.alpha * u.omega
    return power / twice_kinetic(unit)


AT_START = stored(bodies(START, mpf(0), mpf(0))[2])


class Motion:
    """The crank's angle at any time. It starts from rest, so beta = START + s^2, and the time is a smooth function of s: here by polynomials, piece
    by piece, in u from -1 to 1."""

    HALF, TERMS = mpf("0.01"), 24  # of a piece

    def __init__(self, end):
        powers = range(self.TERMS - 1, -1, -1)
        nodes = [cos(pi * (k + mpf(1) / 2) / self.TERMS) for k in range(self.TERMS)]
        fit = matrix([[u**k for k in powers] for u in nodes]) ** -1
        self.pieces, t, middle = [], mpf(0), self.HALF
        while t < end:
            rate = list(fit * matrix([self.rate(middle + self.HALF * u) for u in nodes]))
            law = [c / (k + 1) for k, c in zip(powers, rate)] + [mpf(0)]
            law[-1] = t - polyval(law, -1)
            t = polyval(law, 1)
            self.pieces.append((t, middle, law, rate))
            middle += 2 * self.HALF

    def rate(self, s):
        """dt/du, which is HALF dt/ds."""
        return self.HALF * 2 * s / speed(START + s * s)

    def angle(self, t):
        """Before its start too: time may as well run backwards."""
        t = abs(t)
        _, middle, law, rate = next(piece for piece in self.pieces if t <= piece[0])
        u = mpf(0)
        for _ in range(50):
            change = (t - polyval(law, u)) / polyval(rate, u)
            u += change
            if abs(change) < mpf("1e-25"):
                return START + (middle + self.HALF * u) ** 2
        raise ArithmeticError(f"no angle at t = {t}")


def at(motion, t):
    beta = motion.angle(t)
    omega = speed(beta) if t else mpf(0)
    return bodies(beta, omega, acceleration(beta, omega)), beta


def force_of(r, moment_r, s, moment_s):
    """The force whose moments are these at the arms r and s."""
    return (moment_s * r - moment_r * s) / cross(s, r)


def forces(ks):
    """What each pin exerts on its second body, and the motor's effort: body by body, m a and I alpha with the moments about a pin."""
    _, k2, k3, k4, _, k6, _ = ks
    E, F, G, H = k2.point(-DD).place, k2.origin.place, k4.origin.place, k6.origin.place
    masses = list(zip(MASSES, INERTIAS, ks, centres(ks)))
    ma = [m * c.acceleration for m, _, _, c in masses]

    def moment(number, about):  # of the inertia force of a body, K1 being number 1
        _, i, k, c = masses[number - 1]
        return i * k.alpha + cross(c.place - about, ma[number - 1])

    hook, pull = spring(k3)
    J4 = force_of(E - G, moment(4, G), E - A, moment(4, A) + moment(5, A))
    J5 = force_of(E - H, moment(6, H), E - A, moment(6, A) + moment(7, A))
    on_k2_about_F = moment(2, F) + cross(E - F, J4 + J5)
    J3 = force_of(E - B, moment(3, B) - cross(hook.place - B, pull), E - F, -on_k2_about_F)
    J7, J9 = ma[3] - J4, ma[5] - J5
    J6, J8, J10 = ma[2] - J3 - pull, ma[4] + J7, ma[6] + J9
    J2 = ma[1] + J3 + J4 + J5
    J1 = ma[0] + J2
    effort = moment(1, 0) + cross(F, J2)
    return dict(zip([f"J{k}" for k in range(1, 11)], [J1, J2, J3, J4, J5, J6, J7, J8, J9, J10])), effort


def row(motion, t):
    ks, beta = at(motion, t)
    pins, effort = forces(ks)
    assert abs(effort - TORQUE) < mpf("1e-25"), "Newton and Euler, and the energy, are of one mind"
    cells = {"t": t}
    for name, force in pins.items():
        cells |= {f"{name}.fx": force.real, f"{name}.fy": force.imag}
    return cells | {"motor.effort": effort, "beta": beta, "beta.d": ks[0].omega, "beta.dd": ks[0].alpha}


def angles(ks, beta):
    """The Test Set's, with their rates."""
    pairs = {"Theta": (1, 0), "gamma": (2, None), "Phi": (3, 4), "delta": (4, None), "Omega": (5, 6), "epsilon": (6, None)}
    cells = {"beta": beta, "beta.d": ks[0].omega, "beta.dd": ks[0].alpha}
    for name, (k, base) in pairs.items():
        from_ = Body(Point(mpc(0)), mpc(1), mpf(0), mpf(0)) if base is None else ks[base]
        rates = {f"{name}.d": ks[k].omega - from_.omega, f"{name}.dd": ks[k].alpha - from_.alpha}
        cells |= {name: arg(ks[k].direction / from_.direction)} | rates
    return cells


def check(motion):
    start = row(motion, mpf(0))
    for name, value in PUBLISHED_START.items():
        print(f"start {name:10} {float(value):22.15g} off by {float(abs(start[name] / value - 1)):.1e} of it")
    ks, beta = at(motion, END)
    found = row(motion, END) | angles(ks, beta)
    other = speed(PUBLISHED_END["beta"]) / PUBLISHED_END["beta.d"] - 1
    print(f"end   energy makes of the published angle another speed, by {float(abs(other)):.1e} of it")
    for name, value in PUBLISHED_END.items():
        gap = found[name] - value
        gap -= 2 * pi * round(gap / (2 * pi)) if name == "Theta" else 0
        print(f"end   {name:10} {float(value):22.15g} off by {float(abs(gap / value)):.1e} of it")


def write(name, header, rows):
    with open(FOLDER / name, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def main():
    gap = STEP / (2 * sqrt(mpf(3)))
    motion = Motion(END + (MARGIN + 2) * STEP)
    if "--check" in sys.argv[1:]:
        return check(motion)
    table = []
    for k in range(-MARGIN, int(END / STEP) + MARGIN):
        t = (k + mpf(1) / 2) * STEP
        table.append([nstr(t * 10**6, 6, strip_zeros=True).removesuffix(".0"), *(nstr(motion.angle(t + g), 17) for g in (-gap, gap))])
    write("andrews_squeezer_motion.csv", ["microseconds", "before", "after"], table)
    rows = [row(motion, END * k / ROWS) for k in range(ROWS + 1)]
    write("andrews_squeezer.csv", rows[0], [[nstr(cell, 17) for cell in cells.values()] for cells in rows])


if __name__ == "__main__":
    main()
