"""Sweeps with Ray: workers die on the way, and nothing is missing, nothing there twice, and every bit the same."""

from __future__ import annotations

import json
import os

import pyarrow as pa
import pytest
from conftest import ROOT

import mechc

ray = pytest.importorskip("ray")
import mechc.ray  # noqa: E402

VARY = {"base": mechc.between("60 mm", "220 mm"), "arm": mechc.between("90 mm", "120 mm")}
OPTIONS = {"vary": VARY, "samples": 240, "seed": 3, "results": {"flatness": "max(deviation) - min(deviation)"}}


@pytest.fixture(scope="module")
def local_ray():
    ray.init(num_cpus=2, include_dashboard=False, object_store_memory=200 * 2**20, log_to_driver=False, configure_logging=False)
    yield
    ray.shutdown()


@pytest.fixture(scope="module")
def hoeken():
    return mechc.load(ROOT / "examples/hoeken.mech")


def dying(marks, shares):
    """What makes a share, but ends its own process when the file is half written, the first time that one of ``shares`` is made."""

    # a closure goes to the workers as it is; modules of tests are not there
    def make(row, **more):
        import os
        import signal

        import mechc.ray
        from pyarrow import parquet

        mark = f"{marks}/{int(row['first'])}"
        if int(row["first"]) not in shares or os.path.exists(mark):
            return mechc.ray._make(row, **more)

        class Writer(parquet.ParquetWriter):
            def write_batch(self, batch, *args, **kwargs):
                super().write_batch(batch, *args, **kwargs)
                with open(mark, "w"):
                    os.kill(os.getpid(), signal.SIGKILL)

        parquet.ParquetWriter = Writer
        return mechc.ray._make(row, **more)

    return make


@pytest.mark.timeout(280)
def test_workers_die_and_the_bits_are_the_same(local_ray, hoeken, tmp_path, monkeypatch):
    marks = tmp_path / "marks"
    marks.mkdir()
    monkeypatch.setattr(mechc.ray, "_make", dying(marks, (0, 100, 220)))
    found = mechc.ray.sweep(hoeken, out=tmp_path / "sweep", share=20, **OPTIONS)
    assert sorted(os.listdir(marks)) == ["0", "100", "220"], "three workers died"
    assert found.made == 12 and found.ranges[0] == (0, 20)
    wanted = pa.table(hoeken.sweep(**OPTIONS))
    assert found.to_arrow().combine_chunks().equals(wanted.combine_chunks())
    names = sorted(os.listdir(tmp_path / "sweep"))
    assert names == [*(f"part-{k:012}-{k + 20:012}.parquet" for k in range(0, 240, 20)), "sweep.json"]


@pytest.mark.timeout(280)
def test_a_second_call_makes_what_is_missing(local_ray, hoeken, tmp_path):
    first = mechc.ray.sweep(hoeken, out=tmp_path, share=60, **OPTIONS)
    assert first.made == 4
    os.remove(first.files[1])
    before = {file: os.stat(file).st_mtime_ns for file in first.files if os.path.exists(file)}
    again = mechc.ray.sweep(hoeken, out=tmp_path, share=60, **OPTIONS)
    assert again.made == 1 and all(os.stat(file).st_mtime_ns == at for file, at in before.items())
    assert again.to_arrow().equals(pa.table(hoeken.sweep(**OPTIONS)).cast(again.to_arrow().schema))
    assert mechc.ray.sweep(hoeken, out=tmp_path, share=60, **OPTIONS).made == 0
    told = json.loads((tmp_path / "sweep.json").read_text())
    assert told["variants"] == 240 and told["mechanism"] == "hoeken"
    with pytest.raises(mechc.UsageError, match="another sweep"):
        mechc.ray.sweep(hoeken, out=tmp_path, share=60, **{**OPTIONS, "seed": 4})


def test_what_is_not_for_shares(hoeken, tmp_path):
    for more in ({"skip": 3}, {"take": 3}, {"jobs": 2}, {"until": "flatness > 1"}):
        with pytest.raises(mechc.UsageError, match="not for sweeps of shares"):
            mechc.ray.sweep(hoeken, out=tmp_path, **OPTIONS, **more)


@pytest.mark.timeout(280)
def test_a_folder_is_of_one_sample_wherever_workers_stand(local_ray, hoeken, tmp_path, monkeypatch):
    options = {**OPTIONS, "samples": 4, "share": 2}
    monkeypatch.chdir(tmp_path)
    unseeded = {name: value for name, value in options.items() if name != "seed"}
    found = mechc.ray.sweep(hoeken, out="own", **unseeded)
    assert found.folder == str(tmp_path / "own") and len(os.listdir("own")) == 3
    # the first of Sobol's samples is another one than that without a seed
    with pytest.raises(mechc.UsageError, match="another sweep"):
        mechc.ray.sweep(hoeken, out="own", **{**options, "seed": 0})
