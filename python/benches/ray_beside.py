"""Sweeps with Ray beside one process: what shares, files and workers cost, and what a second worker gains.

    python benches/ray_beside.py [VARIANTS]

As many variants as take a minute or more; without what it takes to start Ray.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

import pyarrow as pa

import mechc
import mechc.ray

HOEKEN = Path(__file__).resolve().parents[2] / "examples/hoeken.mech"


def main():
    import ray

    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    m = mechc.load(HOEKEN)
    options = {
        "vary": {"base": mechc.between("70 mm", "90 mm"), "arm": mechc.between("95 mm", "105 mm")},
        "samples": count,
        "results": {"flatness": "max(deviation) - min(deviation)"},
    }
    began = time.perf_counter()
    wanted = pa.table(m.sweep(jobs=1, **options))
    alone = time.perf_counter() - began
    print(f"one process, one thread   {alone:7.1f} s")
    ray.init(num_cpus=2, include_dashboard=False, object_store_memory=200 * 2**20, log_to_driver=False, configure_logging=False)
    took = {}
    for workers in (1, 2):
        with tempfile.TemporaryDirectory() as folder:
            began = time.perf_counter()
            shares = mechc.ray.sweep(m, out=folder, share=max(count // 20, 1), concurrency=workers, **options)
            took[workers] = time.perf_counter() - began
            assert shares.to_arrow().combine_chunks().equals(wanted.combine_chunks())
        print(f"Ray, workers: {workers}           {took[workers]:7.1f} s, {100 * (took[workers] / alone - 1):+.0f} % of one process")
    print(f"two workers are {took[1] / took[2]:.2f} × as fast as one")


if __name__ == "__main__":
    main()
