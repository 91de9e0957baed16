"""Reactions and efforts of the mechanisms of this folder by Newton's and Euler's laws, body by body.

newton_euler.py MECHC [--check] [NAME ...]

MECHC, a binary of mechc, gives the motion of each text without its masses, loads and forces; all else is written by hand in `by_hand`. The
tables NAME.csv are written anew; with --check none is written, and the worst of each mechanism's numbers is told, as README.md explains. Needs numpy.

Source: Newton's second law and Euler's for a rigid body in the plane, about the centre of mass; Steiner's parallel axes for several masses of a body. No
Lagrange multiplier, no Jacobian of constraints, no derivative by a coordinate is used.
"""

import argparse
import csv
import io
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from by_hand import contacts, linkages, parts  # noqa: F401  (each lists its mechanisms)
from by_hand.diagram import Diagram
from by_hand.drawings import MECHANISMS

FOLDER = Path(__file__).parent
FORCES = re.compile(r"^( *)(mass|gravity|load|measure)\b.*\n(\1 +.*\n)*", re.MULTILINE)  # with what goes on further in
STENCIL = {-3: -1 / 60, -2: 3 / 20, -1: -3 / 4, 1: 3 / 4, 2: -3 / 20, 3: 1 / 60}  # of the first derivative, of sixth order
LIMITS = {"geometry": 1e-13, "condition": 100.0, "residual": 1e-15, "shaken": 1e-11, "power": 1e-10}


def motion(mechc, name, *options):
    """The rows of a text without its masses, loads and forces, each by the names of its columns."""
    with tempfile.TemporaryDirectory() as folder:
        for path in FOLDER.glob("*.mech"):
            (Path(folder) / path.name).write_text(without_forces(path.read_text()))
        command = [mechc, "run", Path(folder) / f"{name}.mech", "--message-format", "short", *options]
        table = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    return [{column: float(cell) for column, cell in row.items()} for row in csv.DictReader(io.StringIO(table))]


def without_forces(text):
    return FORCES.sub("", text)


def diagram(name, row):
    drawn = Diagram(row["t"], row)
    MECHANISMS[name](drawn)
    return drawn


def columns(drawn, solution):
    """A row of the table, in mechc's order: joints, then drivers and constraints, then measures."""
    cells = {"t": drawn.t}
    for joint, (force, moment) in solution.reactions.items():
        cells |= {f"{joint}.fx": force[0], f"{joint}.fy": force[1]}
        if drawn.joints[joint].has_torque:
            cells[f"{joint}.torque"] = moment
    cells |= {f"{driver}.effort": size for driver, size in solution.efforts.items()}
    cells |= {name: of(solution) for name, of in drawn.measures.items()}
    return {name: float(cell) + 0.0 for name, cell in cells.items()}  # no negative zeros


def write(mechc, name):
    drawings = [diagram(name, row) for row in motion(mechc, name)]
    rows = without_dust([columns(drawn, drawn.solve()) for drawn in drawings])
    with open(FOLDER / f"{name}.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def without_dust(rows):
    """A column that is zero by its geometry, such as the moment of a force whose line goes through the point, has nothing but rounding."""
    size = {column: max(abs(row[column]) for row in rows) for column in rows[0]}
    dust = 1e-14 * max(size[column] for column in size if column != "t")
    return [{c: 0.0 if size[c] < dust else cell for c, cell in row.items()} for row in rows]


def check(mechc, name):
    """Tells the worst of all rows, and whether all of it is within the limits."""
    rows = motion(mechc, name)
    drawings = [diagram(name, row) for row in rows]
    solutions = [drawn.solve() for drawn in drawings]
    worst = [
        max((abs(gap) for drawn in drawings for joint in drawn.joints.values() for gap in joint.gaps), default=0.0),
        max(solution.condition for solution in solutions),
        max(solution.residual for solution in solutions),
        shaken(name, rows, solutions),
        unbalanced(mechc, name, drawings, solutions),
    ]
    print(f"{name:20} {len(rows):4}" + "".join(f" {number:10.1e}" for number in worst))
    return all(number <= limit for number, limit in zip(worst, LIMITS.values()))


def shaken(name, rows, solutions):
    """How much of a column's largest number changes if each number of the motion is off by 1e-14 of the largest in its column, which is more
    than it is by rounding."""
    random = np.random.default_rng(1)
    largest = {column: max(abs(row[column]) for row in rows) for column in rows[0]}
    off = [{c: cell + 1e-14 * largest[c] * random.uniform(-1, 1) for c, cell in row.items()} for row in rows]
    drawings = [diagram(name, row) for row in rows]
    want = without_dust([columns(drawn, solution) for drawn, solution in zip(drawings, solutions)])
    got = [columns(drawn, drawn.solve()) for drawn in (diagram(name, row) for row in off)]
    size = {c: max(abs(row[c]) for row in want) for c in want[0]}
    return max(abs(a[c] - b[c]) / size[c] for a, b in zip(got, want) for c in size if size[c])


def unbalanced(mechc, name, drawings, solutions):
    """The power of efforts and loads less the rate of kinetic and potential energy, relative to the largest of these terms. All rates are
    differences of values that belong to six neighbouring times: none is a velocity that the forces were computed with."""
    times = [drawn.t for drawn in drawings]
    h = (times[-1] - times[0]) / 2000
    near = neighbours(mechc, name, times, h)
    terms = []
    for k, (drawn, solution) in enumerate(zip(drawings, solutions)):
        rates = sum(weight * near[k, step].energy_and_quantities() for step, weight in STENCIL.items()) / h
        terms.append(rates * [-1.0, *drawn.generalized_forces(solution)])
    return np.max(np.abs(np.sum(terms, axis=1))) / np.max(np.abs(terms))


def neighbours(mechc, name, times, h):
    """The diagrams at the times of the stencil around each time, by (number of the time, step)."""
    wanted = {(k, step): t + step * h for k, t in enumerate(times) for step in STENCIL}
    order = sorted(wanted, key=wanted.get)
    at = [f"--at={wanted[key]!r}" for key in order]
    rows = motion(mechc, name, f"--from={times[0] - 4 * h!r}", *at)
    assert len(rows) == len(order), f"{name}: {len(rows)} rows for {len(order)} times"
    return {key: diagram(name, row) for key, row in zip(order, rows)}


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("mechc")
    options.add_argument("--check", action="store_true", help="write nothing, tell how good the numbers are")
    options.add_argument("names", nargs="*", metavar="NAME", help="these mechanisms alone")
    given = options.parse_intermixed_args()
    names = given.names or MECHANISMS
    if not given.check:
        for name in names:
            write(given.mechc, name)
        return
    print(f"{'':20} {'rows':>4}" + "".join(f" {column:>10}" for column in LIMITS))
    bad = [name for name in names if not check(given.mechc, name)]
    if bad:
        sys.exit(f"beyond the limits: {', '.join(bad)}")


if __name__ == "__main__":
    main()
