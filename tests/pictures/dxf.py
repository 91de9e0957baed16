"""Reads the DXF of examples with ezdxf: each is sound, and lengths are right to a micrometre.

dxf.py MECHC FOLDER, where the examples are.
"""

import csv
import io
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import ezdxf

MICROMETRE = 1e-3  # in millimetres
mechc, examples = sys.argv[1], Path(sys.argv[2])


class Drawing:
    """Points and polylines by their layers, in millimetres."""

    def __init__(self, name, *options):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "drawing.dxf"
            subprocess.run([mechc, "view", examples / f"{name}.mech", "-o", path, *options], check=True)
            document = ezdxf.readfile(path)
        audit = document.audit()
        assert not audit.errors and not audit.fixes, f"{name}: {audit.errors} {audit.fixes}"
        assert document.units == ezdxf.units.MM, f"{name} is in {document.units}"
        self.points, self.lines = {}, {}
        for entity in document.modelspace():
            layer = entity.dxf.layer
            if entity.dxftype() == "POINT":
                self.points[layer] = entity.dxf.location.vec2
            else:
                places = [vertex.dxf.location.vec2 for vertex in entity.vertices]
                self.lines.setdefault(layer, []).append(places + places[:1] if entity.is_closed else places)

    def length(self, a, b):
        return (self.points[a] - self.points[b]).magnitude


def table(name, *columns):
    run = subprocess.run([mechc, "run", examples / f"{name}.mech"], check=True, capture_output=True, text=True)
    rows = csv.DictReader(io.StringIO(run.stdout))
    return [[float(row[column]) for column in columns] for row in rows]


def near(value, wanted, what):
    assert abs(value - wanted) < MICROMETRE, f"{what}: {value} instead of {wanted}"


def all_are_sound():
    names = sorted(path.stem for path in examples.glob("*.mech"))
    return {name: Drawing(name) for name in names}


def circles_are_round(drawings):
    tappet = drawings["eccentric_tappet"]
    for layer, middle, radius in [("disc_rim", "disc_C", 25.0), ("pushrod_roller", "pushrod_centre", 16.0)]:
        (line,) = tappet.lines[layer]
        for a, b in zip(line, line[1:]):
            near((a - tappet.points[middle]).magnitude, radius, layer)
            # a chord is farthest from its arc in its middle
            near(((a + b) / 2 - tappet.points[middle]).magnitude, radius, layer)


def bars_are_long(drawings):
    crank = drawings["slider_crank"]
    near(crank.length("crank_journal", "crank_pin"), 50.0, "crank")
    near(crank.length("rod_big_end", "rod_small_end"), 150.0, "rod")
    near(crank.length("crank_pin", "rod_big_end"), 0.0, "pin")
    half = Drawing("slider_crank", "--scale", "1:2", "--at", "7ms")
    near(half.length("rod_big_end", "rod_small_end"), 75.0, "rod at 1:2")


def traces_run_through_the_table(drawings):
    (line,) = drawings["film_claw"].lines["tip"]
    for x, y in table("film_claw", "tip.x", "tip.y"):
        a = ezdxf.math.Vec2(x, y)
        near(min((a - b).magnitude for b in line), 0.0, "tip")


def wheels_are_their_pitch_circles(drawings):
    gear = drawings["planetary_gear"]
    (line,) = gear.lines["sun"]
    radii = [(place - gear.points["sun_O"]).magnitude for place in line]
    near(max(radii), 15.0, "pitch circle")
    near(min(radii), 15.0, "pitch circle")
    assert math.isclose(radii[0], radii[-1]), "it is closed"


drawings = all_are_sound()
for check in (circles_are_round, bars_are_long, traces_run_through_the_table, wheels_are_their_pitch_circles):
    check(drawings)
print(f"{len(drawings)} drawings are read back by ezdxf, lengths right to 1 µm")
