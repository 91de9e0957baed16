"""Sweeps with Ray beside one process: what shares, files and workers cost, and what a second worker gains.

    python python/benches/ray_beside.py [VARIANTS]

A minute or more of work for one worker, in rounds that take turns with one process, forwards and backwards: a machine that others use too
has another pace a minute later. Shares are as large as they are where nothing is said. What it takes until Ray and its workers stand is told
by itself.
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

#: In each round a pipeline begins anew, which Ray lets have its second core after a second: rounds are long.
ROUNDS = 2


def main():
    import ray

    count = int(sys.argv[1]) if len(sys.argv) > 1 else 240_000
    each = max(count // ROUNDS, 1)
    m = mechc.load(HOEKEN)

    def options(variants):
        return {
            "vary": {"base": mechc.between("70 mm", "90 mm"), "arm": mechc.between("95 mm", "105 mm")},
            "samples": variants,
            "results": {"flatness": "max(deviation) - min(deviation)"},
        }

    wanted = pa.table(m.sweep(jobs=1, **options(each))).combine_chunks()

    def process(threads):
        return lambda: pa.table(m.sweep(jobs=threads, **options(each)))

    def workers(count, variants=each):
        def sweep():
            with tempfile.TemporaryDirectory() as folder:
                return mechc.ray.sweep(m, out=folder, concurrency=count, **options(variants)).to_arrow()

        return sweep

    def took(sweep):
        began = time.perf_counter()
        made = sweep()
        return time.perf_counter() - began, made

    began = time.perf_counter()
    ray.init(num_cpus=2, include_dashboard=False, object_store_memory=200 * 2**20, log_to_driver=False, configure_logging=False)
    workers(2, variants=2_000)()
    print(f"until Ray and its workers stand   {time.perf_counter() - began:7.1f} s")
    kinds = {"one thread": process(1), "Ray, one worker": workers(1), "two threads": process(2), "Ray, two workers": workers(2)}
    all_of = dict.fromkeys(kinds, 0.0)
    for number in range(ROUNDS):
        for kind in list(kinds) if number % 2 == 0 else reversed(kinds):
            seconds, made = took(kinds[kind])
            all_of[kind] += seconds
            assert made.combine_chunks().equals(wanted)
    for kind, seconds in all_of.items():
        print(f"{kind:33} {seconds:7.1f} s")
    one, two = (all_of[kind] for kind in ("Ray, one worker", "Ray, two workers"))
    print(f"one worker takes {100 * (one / all_of['one thread'] - 1):+.0f} % of one thread")
    print(f"two workers are {one / two:.2f} × as fast as one, two threads {all_of['one thread'] / all_of['two threads']:.2f} ×")


if __name__ == "__main__":
    main()
