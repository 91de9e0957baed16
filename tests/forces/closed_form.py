"""The slider-crank in closed form: what its bearings carry and its shaft needs, as textbooks write it down.

closed_form.py

Writes `slider_crank_closed_form.csv`. Nothing is solved for but one unknown after the other: piston, rod, crank. Needs mpmath; no mechc.

Its derivatives by params are differences of these forms, of second order, which 34 digits allow to be as exact as the rest.

Source: the dynamic force analysis of the slider-crank by Newton's and Euler's laws, as in R. L. Norton, Design of Machinery, and J. J. Uicker, G. R.
Pennock, J. E. Shigley, Theory of Machines and Mechanisms; the rod's angle and its derivatives follow from l sin(phi) = e - r sin(theta).
"""

import csv
from dataclasses import astuple, dataclass, replace
from pathlib import Path

from mpmath import cos, mp, mpf, nstr, pi, sin, sqrt

mp.dps = 34

start = 25 * pi / 180
inlet, top, bottom, exponent = mpf("1e5"), mpf("0.186"), mpf("0.092"), mpf("1.3")
m_crank, m_rod, m_piston = mpf("3.1"), mpf("0.62"), mpf("0.47")
u, v = mpf("-0.007"), mpf("0.002")  # the crank's centre of mass, in its frame
b, I = mpf("0.039"), mpf("1.75e-3")  # the rod's, from the big end, and its inertia about it
c = mpf("0.008")  # the piston's, before the wrist pin
g = mpf("9.81")


@dataclass(frozen=True)
class Machine:
    """What the two machines differ in, or derivatives are taken by: m, rad/s, m^2."""

    offset: mpf  # of the cylinder's axis from the shaft
    throw: mpf = mpf("0.042")
    rod_length: mpf = mpf("0.134")
    speed: mpf = mpf(2900) * 2 * pi / 60
    area: mpf = mpf("0.0041")


def forces(t, machine):
    """Forces on rod, piston and crank (big, small, barrel, main), the barrel's couple and the shaft's torque."""
    e, r, l, w, area = astuple(machine)
    theta = start + w * t
    S, C = sin(theta), cos(theta)

    # the rod's angle and its derivatives, with the piston's and the rod's centres' accelerations
    sn = (e - r * S) / l
    cs = sqrt(1 - sn * sn)
    w_rod = -r * w * C / (l * cs)
    alpha = (r * w * w * S + l * w_rod**2 * sn) / (l * cs)
    x = r * C + l * cs
    a_piston = -r * w * w * C - l * (w_rod**2 * cs + alpha * sn)
    a_x = -r * w * w * C - b * (w_rod**2 * cs + alpha * sn)
    a_y = -r * w * w * S - b * (w_rod**2 * sn - alpha * cs)
    a_crank_x, a_crank_y = -w * w * (C * u - S * v), -w * w * (S * u + C * v)

    gas = area * inlet * (((top - bottom) / (top - x)) ** exponent - 1)
    small_x = m_piston * a_piston + gas  # along the cylinder
    small_y = sn / cs * small_x - (I * alpha + m_rod * b * (cs * (a_y + g) - sn * a_x)) / (l * cs)  # the rod, about the big end
    barrel_y = m_piston * g - small_y
    couple = m_piston * g * c
    big_x, big_y = m_rod * a_x + small_x, m_rod * (a_y + g) + small_y
    main_x, main_y = m_crank * a_crank_x + big_x, m_crank * (a_crank_y + g) + big_y
    torque = r * (C * big_y - S * big_x) + m_crank * g * (C * u - S * v)

    # no work is lost
    v_piston = -r * w * S - l * w_rod * sn
    v_x, v_y = -r * w * S - b * w_rod * sn, r * w * C + b * w_rod * cs
    power = m_piston * a_piston * v_piston + m_rod * (a_x * v_x + (a_y + g) * v_y) + I * alpha * w_rod
    power += gas * v_piston + m_crank * g * w * (C * u - S * v)
    assert abs(torque * w - power) < mpf("1e-25") * abs(gas * r * w)

    return {
        "main": (main_x, main_y),
        "big": (big_x, big_y),
        "small": (small_x, small_y),
        "barrel": (mpf(0), barrel_y, couple),
        "torque": torque,
    }


def derivative(t, machine, param, of):
    """Of a force, by a param."""
    value = getattr(machine, param)
    h = value / 10**10
    more, less = (of(forces(t, replace(machine, **{param: value + d}))) for d in (h, -h))
    return (more - less) / (2 * h)


def row(t):
    level, above = Machine(offset=mpf(0)), Machine(offset=mpf("0.019"))
    cells = {"t": t}
    for i, found in enumerate((forces(t, level), forces(t, above))):
        for joint in ("main", "big", "small"):
            cells |= {f"{joint}[{i}].{part}": value for part, value in zip(("fx", "fy"), found[joint])}
        barrel = ("level", "above")[i]
        cells |= {f"{barrel}.{part}": value for part, value in zip(("fx", "fy", "torque"), found["barrel"])}
        cells[f"motor[{i}].effort"] = found["torque"]
    return cells | {
        "bearing_by_throw": derivative(t, above, "throw", lambda f: f["main"][0]),
        "thrust_by_length": derivative(t, above, "rod_length", lambda f: f["barrel"][1]),
        "torque_by_speed": derivative(t, above, "speed", lambda f: f["torque"]),
        "torque_by_area": derivative(t, level, "area", lambda f: f["torque"]),
    }


def main():
    rows = [row(mpf("0.00035") * k) for k in range(61)]
    with open(Path(__file__).parent / "slider_crank_closed_form.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(rows[0])
        writer.writerows([nstr(cell, 20) for cell in cells.values()] for cells in rows)


if __name__ == "__main__":
    main()
