"""What does not fit into memory is refused in words, and the interpreter goes on."""

from __future__ import annotations

import subprocess
import sys
import textwrap
import tracemalloc

import numpy as np
import pytest
from conftest import ROOT

import mechc
from mechc import memory

CRANK = ROOT / "examples/slider_crank.mech"
RANGE = {"rod_length": mechc.between(0.1, 0.2)}
TOP = {"top": "max(travel)"}


@pytest.fixture(scope="module")
def crank():
    return mechc.load(CRANK)


def test_a_sweep_beyond_memory_says_how_large_it_is_and_names_the_stream(crank):
    sweep = crank.sweep(RANGE, samples=10**12, results=TOP, yes=True)
    for read in (sweep.read, sweep.to_polars, sweep.to_pandas):
        with pytest.raises(mechc.TooLarge, match="1000000000000 rows of 5 columns take 40 TB") as caught:
            read()
    assert isinstance(caught.value, MemoryError) and isinstance(caught.value, ValueError)
    assert "RecordBatchReader.from_stream(sweep)" in str(caught.value) and "skip=K, take=N" in str(caught.value)
    assert caught.value.diagnostics[0]["data"] == {"rows": 10**12, "columns": 5, "bytes": 40 * 10**12}


def test_a_run_beyond_memory(crank):
    with pytest.raises(mechc.TooLarge, match=r"rows of 34 columns take .* TB, and .* of memory are free"):
        crank.run(to=1000, every=1e-9)


def test_a_function_beyond_memory(crank):
    with pytest.raises(mechc.TooLarge, match="of 1 columns take .* TB"):
        crank.objective("top", by=["rod_length"], results=TOP, to=1000, every=1e-10)


def test_variants_whose_rows_alone_are_beyond_memory(crank):
    sweep = crank.sweep({"rod_length": [0.15]}, rows=True, to=1000, every=1e-9)
    with pytest.raises(mechc.TooLarge, match="side by side"):
        sweep.read()
    with pytest.raises(mechc.TooLarge, match="side by side"):
        sweep.__arrow_c_stream__()


def test_elements_beyond_memory(crank):
    few = np.zeros(1 << 20)
    with pytest.raises(mechc.TooLarge):
        crank.at(np.broadcast_to(few, (1 << 20, 1 << 20)))


@pytest.mark.parametrize("each", [1 << 16, 1 << 40])
def test_elements_are_counted_before_they_are_spread_out(crank, monkeypatch, each):
    """A time each way, which are together more than there can be; the larger is more than numpy counts."""
    monkeypatch.setattr(memory, "_free", lambda: 10**9)
    down, across = np.broadcast_to(0.01, (each, 1)), np.broadcast_to(0.15, (1, each))
    tracemalloc.start()
    try:
        for ask in (lambda: crank.at(down, rod_length=across), lambda: crank.at(np.broadcast_to(0.01, (1 << 16, 1 << 16)))):
            with pytest.raises(mechc.TooLarge, match="rows of 10 columns or more take .* or more, and 1 GB of memory are free") as caught:
                ask()
            assert caught.value.diagnostics[0]["data"]["rows"] in (each**2, 1 << 32)
        assert tracemalloc.get_traced_memory()[1] < 10 << 20
    finally:
        tracemalloc.stop()


def test_what_numpy_spread_out_is_what_it_would_be_by_itself(crank):
    times, rods = np.array([0.0, 0.01, 0.02]), np.array([[0.15], [0.16]])
    spread = crank.at(np.broadcast_to(times, (2, 3)), rod_length=np.broadcast_to(rods, (2, 3)))
    alone = [[crank.at(t, rod_length=rod)["piston.x"] for t in times] for rod in rods[:, 0]]
    assert spread.shape == (2, 3) and spread["piston.x"].tolist() == alone == crank.at(times, rod_length=rods)["piston.x"].tolist()
    with pytest.raises(mechc.UsageError, match="not finite"):
        crank.at(np.broadcast_to([0.0, np.nan], (3, 2)))
    with pytest.raises(mechc.UsageError, match="4294967296 values are given for 1 params"):
        crank.objective("top", by="rod_length", results=TOP)(np.broadcast_to(0.15, (1 << 16, 1 << 16)))
    assert crank.at(np.broadcast_to(0.01, (0, 4))).q.shape == (0, 4, 9)


def test_one_that_ends_early_is_read_whatever_it_could_have_been(crank):
    sweep = crank.sweep({"rod_length": mechc.between(0.15, 0.2)}, samples=10**12, results=TOP, until="top > 0.1 m", yes=True)
    assert sweep.read().rows == 1


def test_as_many_variants_are_asked_about(crank):
    with pytest.raises(mechc.UsageError, match=r"these are 1000000000000 variants\n = help: add `yes=True`"):
        crank.sweep(RANGE, samples=10**12)
    with pytest.raises(mechc.UsageError, match="these are 1000000001 variants"):
        crank.sweep({"rod_length": mechc.between(0.1, 0.2, 10**9 + 1)})
    assert crank.sweep(RANGE, samples=10**12, skip=10**11, take=10).variants == 10
    assert crank.sweep(RANGE, samples=10**12, yes=True).variants == 10**12
    with pytest.raises(mechc.UsageError, match="`yes` is 'please'"):
        crank.sweep(RANGE, samples=3, yes="please")


@pytest.mark.skipif(sys.platform != "linux", reason="the limit is one of Linux")
@pytest.mark.parametrize(
    "work",
    [
        "m.sweep(vary, samples=10**8, results=top).read()",
        "m.sweep(vary, samples=10**6, rows=True, columns='travel').read()",
        "m.run(to=1000, every=1e-5)",
        "m.at(np.zeros(50_000_000))",
    ],
)
def test_a_process_that_is_kept_small_is_not_ended(work):
    """Within two gigabytes, of which what is asked for takes more."""
    code = f"""
        import resource
        import numpy as np
        import mechc
        m = mechc.load("examples/slider_crank.mech")
        m.at(0.0)
        vary, top = {{"rod_length": mechc.between(0.1, 0.2)}}, {{"top": "max(travel)"}}
        resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
        try:
            {work}
        except MemoryError as why:
            print("told", type(why).__name__)
        resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
        print(m.run().rows)
    """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=100, cwd=ROOT)
    assert done.stdout.split() == ["told", "TooLarge", "81"], (done.returncode, done.stdout, done.stderr)
