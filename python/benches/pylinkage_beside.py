"""Four-bars beside pylinkage with numba: the same linkages, the same crank angles, in one run, on one core.

    pip install 'pylinkage[numba]'
    python python/benches/pylinkage_beside.py [VARIANTS]

pylinkage gives positions alone, and recomputes nothing else; mechc follows each variant along its branch, with every row's residual proven. Times
are the least of several rounds, of the processor where two are compared.
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np
import pyarrow as pa

import mechc

STEPS = 360
ROUNDS = 3
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


def by_step_fast(variants):
    """As its documentation has it: a linkage whose lengths are set, `compile()`, `step_fast()`."""
    from pylinkage import Crank, Ground, Linkage, RRRDyad

    base, end = Ground(0.0, 0.0), Ground(4.0, 0.0)
    crank = Crank(anchor=base, radius=1.0, angular_velocity=2 * math.pi / STEPS)
    knee = RRRDyad(anchor1=crank.output, anchor2=end, distance1=3.0, distance2=3.0)
    linkage = Linkage([base, end, crank, knee])

    def all_of(count):
        for knee.distance1, knee.distance2 in zip(variants["coupler"][:count], variants["rocker"][:count]):
            linkage.compile()
            found = linkage.step_fast(STEPS)
        return found

    all_of(2)  # compiled before the clock runs
    return all_of


def by_its_loop(variants):
    """Its compiled loop alone, on arrays that are laid out once: two fixed points, a crank, and a pin that two links hold."""
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

    all_of(2)
    return all_of


def read(sweep):
    """Reads a sweep batch by batch, and lets each go, as the arrays of the other are: how many rows there were, and the last batch."""
    rows, last = 0, None
    for batch in pa.RecordBatchReader.from_stream(sweep):
        rows, last = rows + batch.num_rows, batch
    return rows, last


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    variants = lengths(count)
    m = mechc.parse(TEXT)
    ways = {"step_fast()": by_step_fast(variants), "its loop alone": by_its_loop(variants)}
    sweeps = {
        name: m.sweep(variants=variants, rows=True, columns=columns, jobs=1)
        for name, columns in (("positions", ["bx", "by", "cx", "cy"]), ("with velocities and accelerations", ["bx*", "by*", "cx*", "cy*"]))
    }
    rows, least, last = count * STEPS, {}, None
    # in turn: a machine that others use too is slow for all of them
    for _ in range(ROUNDS):
        for name, way in ways.items():
            took, last = timed(lambda: way(count))
            least[name] = min(took, least.get(name, took), key=lambda took: took[1])
        for name, sweep in sweeps.items():
            took, (there, batch) = timed(lambda: read(sweep))
            assert there == rows
            away = max(np.abs(batch[column].to_numpy()[-STEPS:] - last[:, *of]).max() for column, of in PLACES.items())
            assert away < 1e-9, f"{name}: {away}"
            least[name] = min(took, least.get(name, took), key=lambda took: took[1])
    for name in ways:
        print(f"pylinkage with numba, positions, {name}: {of_a_row(least[name], rows)}")
    for name in sweeps:
        times = (f"{least[way][1] / least[name][1]:.2f} × as fast as {way}" for way in ways)
        print(f"mechc, {name}: {of_a_row(least[name], rows)}, {', '.join(times)}")


if __name__ == "__main__":
    main()
