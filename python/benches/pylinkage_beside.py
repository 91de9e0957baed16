"""Four-bars beside pylinkage with numba: the same linkages, the same crank angles, in one run, on one core.

    pip install 'pylinkage[numba]'
    python benches/pylinkage_beside.py [VARIANTS]

pylinkage gives positions alone, and recomputes nothing else; mechc follows each variant along its branch, with every row's residual proven.
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np
import pyarrow as pa

import mechc

STEPS = 360
TEXT = """mechanism four_bar {
    param crank = 1
    param coupler = 3
    param rocker = 3
    param base = 4
    ground { point A = (0, 0) point D = (base, 0) }
    body a at (0, 0, 0) { point A = (0, 0) point B = (crank, 0) }
    body b at (crank, 0, 60 deg) { point B = (0, 0) point C = (coupler, 0) }
    body c at (base, 0, 120 deg) { point D = (0, 0) point C = (rocker, 0) }
    joint jA: revolute(ground.A, a.A)
    joint jB: revolute(a.B, b.B)
    joint jC: revolute(b.C, c.C)
    joint jD: revolute(ground.D, c.D)
    driver motor: rotation(jA) = 1 rev/s * t
    measure bx = x(a.B)
    measure by = y(a.B)
    measure cx = x(b.C)
    measure cy = y(b.C)
    analysis from 0 s to 359 s / 360 every 1 s / 360
}
"""


#: Where pylinkage has what mechc measures: joint and coordinate.
PLACES = {"bx": (2, 0), "by": (2, 1), "cx": (3, 0), "cy": (3, 1)}


def lengths(count):
    rng = np.random.default_rng(5)
    return {"coupler": rng.uniform(2.8, 3.2, count), "rocker": rng.uniform(2.8, 3.2, count)}


def timed(work):
    """What it takes (s), by the clock and of the processor, and what it gives. Where others use the machine too, the latter tells more."""
    began = time.perf_counter(), time.process_time()
    found = work()
    return (time.perf_counter() - began[0], time.process_time() - began[1]), found


def of_a_row(took, rows):
    return f"{took[0] / rows * 1e9:.0f} ns a row ({took[1] / rows * 1e9:.0f} ns of the processor)"


def of_pylinkage(variants):
    """Its own compiled loop, called for one linkage after the other: two fixed points, a crank, and a pin that two links hold."""
    from pylinkage.solver import JOINT_CRANK, JOINT_REVOLUTE, JOINT_STATIC, MAX_PARENTS, simulate

    kinds = np.array([JOINT_STATIC, JOINT_STATIC, JOINT_CRANK, JOINT_REVOLUTE], dtype=np.int32)
    parents = np.full((4, MAX_PARENTS), -1, dtype=np.int32)
    parents[2, 0], parents[3, :2] = 0, (2, 1)
    offsets, order = np.array([0, 0, 0, 2], dtype=np.int32), np.array([0, 1, 2, 3], dtype=np.int32)
    constraints = np.array([1.0, 2 * math.pi / STEPS, 3.0, 3.0])
    # one step behind the first position, from where each step goes on
    start = np.array([[0.0, 0.0], [4.0, 0.0], [math.cos(-2 * math.pi / STEPS), math.sin(-2 * math.pi / STEPS)], [2.5, 2.6]])

    def all_of(count):
        for coupler, rocker in zip(variants["coupler"][:count], variants["rocker"][:count]):
            constraints[2:] = coupler, rocker
            found = simulate(start.copy(), constraints, kinds, parents, offsets, order, STEPS, 1.0)
        return found

    all_of(2)  # compiled before the clock runs
    return all_of


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    variants = lengths(count)
    m = mechc.parse(TEXT)
    beside = of_pylinkage(variants)
    took_beside, last = timed(lambda: beside(count))
    rows = count * STEPS
    print(f"pylinkage with numba, positions: {of_a_row(took_beside, rows)}")
    for name, columns in (("positions", ["bx", "by", "cx", "cy"]), ("with velocities and accelerations", ["bx*", "by*", "cx*", "cy*"])):
        sweep = m.sweep(variants=variants, rows=True, columns=columns, jobs=1)
        took, table = timed(lambda: pa.table(sweep))
        assert table.num_rows == count * STEPS
        away = max(np.abs(table[column].to_numpy()[-STEPS:] - last[:, *of]).max() for column, of in PLACES.items())
        times, of_processor = (beside / own for beside, own in zip(took_beside, took))
        told = f"{times:.2f} × as fast ({of_processor:.2f} ×)"
        print(f"mechc, {name}: {of_a_row(took, rows)}, {told}; positions differ by {away:.0e}")


if __name__ == "__main__":
    main()
