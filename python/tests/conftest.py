"""What the tests share: the command that the numbers are held against, and the mechanisms of the project."""

from __future__ import annotations

import csv
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.mech"))


#: A four-bar whose crank does not turn beyond 90 degrees: no way leads to the other side, where it can be assembled too.
OTHER_SIDE = """mechanism other_side {
    param turned = 60 deg
    ground { point O = (0, 0) point Q = (80 mm, 0) }
    body crank at (0, 0, turned) { point O = (0, 0) point C = (60 mm, 0) }
    body coupler at (60 mm * cos(turned), 60 mm * sin(turned), 0) { point C = (0, 0) point D = (50 mm, 0) }
    body rocker at (80 mm, 0, 90 deg) { point Q = (0, 0) point D = (50 mm, 0) }
    joint main: revolute(ground.O, crank.O)
    joint pin: revolute(crank.C, coupler.C)
    joint knee: revolute(coupler.D, rocker.D)
    joint pivot: revolute(ground.Q, rocker.Q)
    driver motor: rotation(main) = turned + 1 deg/s * t
    measure high = y(coupler.D)
    analysis from 0 s to 1 s every 0.1 s
}
"""


def command_path() -> Path:
    """The command of this project, as it was built last."""
    told = os.environ.get("MECHC")
    if told:
        return Path(told)
    built = [ROOT / "target" / kind / "mechc" for kind in ("debug", "release")]
    built = [path for path in built if path.exists()]
    assert built, "build the command first: cargo build"
    return max(built, key=lambda path: path.stat().st_mtime)


class Ended:
    """What a command wrote, and how it ended."""

    def __init__(self, code: int, out: str, err: str) -> None:
        self.code, self.out, self.err = code, out, err

    def table(self) -> dict[str, list[str]]:
        rows = list(csv.reader(self.out.splitlines()))
        return {name: [row[k] for row in rows[1:]] for k, name in enumerate(rows[0])}


def command(*arguments: str, cwd: Path = ROOT) -> Ended:
    done = subprocess.run([str(command_path()), *map(str, arguments)], capture_output=True, text=True, cwd=cwd, timeout=120)
    return Ended(done.returncode, done.stdout, done.stderr)


def numbers(cells: list[str]) -> np.ndarray:
    return np.array([float(cell) if cell else np.nan for cell in cells])


def same_bits(found: np.ndarray, wanted: list[str] | np.ndarray) -> bool:
    """Whether numbers are those of a table, to the bit; what is missing there is no number here."""
    wanted = numbers(wanted) if isinstance(wanted, list) else wanted
    found = np.where(np.isfinite(found), found, np.nan)
    return found.shape == wanted.shape and np.array_equal(found.view(np.uint64), wanted.view(np.uint64))


@pytest.fixture(scope="session")
def root() -> Path:
    return ROOT
