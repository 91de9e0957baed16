"""Memory while many rows are streamed: a hundred million by default.

    python python/benches/memory.py [ROWS]
"""

from __future__ import annotations

import resource
import sys
from pathlib import Path

import pyarrow as pa

import mechc

HOEKEN = Path(__file__).resolve().parents[2] / "examples/hoeken.mech"


def main():
    rows = int(float(sys.argv[1])) if len(sys.argv) > 1 else 100_000_000
    m = mechc.load(HOEKEN)
    sweep = m.sweep(
        vary={"base": mechc.between("70 mm", "90 mm")}, samples=-(-rows // 1001), rows=True, columns=["pen_x"], every="2 ms"
    )
    seen = 0
    for batch in pa.RecordBatchReader.from_stream(sweep):
        seen += batch.num_rows
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{seen} rows, at most {peak:.0f} MB")


if __name__ == "__main__":
    main()
