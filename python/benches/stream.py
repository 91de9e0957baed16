"""What of a sweep is its Arrow stream: the part of the process's time that the thread takes that reads.

    python python/benches/stream.py [VARIANTS]

Another thread computes, and whoever reads puts blocks together into batches and hands these over; it is its own time that is counted, not that
for which it waits, so that a machine which others use too tells the same.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import pyarrow as pa

import mechc

HOEKEN = Path(__file__).resolve().parents[2] / "examples/hoeken.mech"


def share(sweep):
    reading, all_of_it = time.thread_time(), time.process_time()
    rows = sum(batch.num_rows for batch in pa.RecordBatchReader.from_stream(sweep))
    reading, all_of_it = time.thread_time() - reading, time.process_time() - all_of_it
    return rows, reading / all_of_it


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 20_000
    m, vary = mechc.load(HOEKEN), {"base": mechc.between("70 mm", "90 mm")}
    kinds = {
        "rows of two columns": {"rows": True, "columns": ["pen_x", "pen_y"], "every": "10 ms"},
        "rows of all columns": {"rows": True, "every": "50 ms"},
        "results": {"results": {"flatness": "max(deviation) - min(deviation)"}},
    }
    for name, options in kinds.items():
        variants = count if "results" not in options else max(count // 20, 1)
        rows, part = share(m.sweep(vary, samples=variants, jobs=1, **options))
        print(f"{name}: {rows} of {variants} variants, {100 * part:.1f} % of the time is the stream")


if __name__ == "__main__":
    main()
