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
@pytest.mark.parametrize("tasks", [1, 8])
def test_workers_die_and_the_bits_are_the_same(local_ray, hoeken, tmp_path, monkeypatch, tasks):
    monkeypatch.setattr(mechc.ray, "TASKS_OF_A_CORE", tasks)
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
def test_a_task_leaves_the_shares_that_are_there(local_ray, hoeken, tmp_path, monkeypatch):
    """A task of several shares begins anew where its worker died; what that one wrote stays as it is."""
    monkeypatch.setattr(mechc.ray, "TASKS_OF_A_CORE", 1)
    (tmp_path / "marks").mkdir()

    def noting(make, folder):
        # the file that was there when the worker died
        def noted(row, **more):
            import os

            first = f"{folder}/part-000000000000-000000000080.parquet"
            if int(row["first"]) == 80 and not os.path.exists(f"{folder}/../at"):
                with open(f"{folder}/../at", "w") as file:
                    file.write(str(os.stat(first).st_mtime_ns))
            return make(row, **more)

        return noted

    folder = tmp_path / "sweep"
    monkeypatch.setattr(mechc.ray, "_make", noting(dying(tmp_path / "marks", (80,)), folder))
    found = mechc.ray.sweep(hoeken, out=folder, share=80, concurrency=1, **OPTIONS)
    assert os.listdir(tmp_path / "marks") == ["80"] and found.made == 3
    assert os.stat(found.files[0]).st_mtime_ns == int((tmp_path / "at").read_text())


def test_shares_are_neither_many_nor_small_nor_huge(hoeken):
    def usual(samples, tasks=16, **more):
        return mechc.ray._usual_share(hoeken.sweep(vary=VARY, samples=samples, yes=True, **more), tasks)

    assert [usual(samples) for samples in (1, 240, 200_001, 10_000_000, 30_000_000)] == [1_000, 1_000, 2_000, 50_000, 200_000]
    assert usual(10_000_000, tasks=1_000) == 10_000
    numbers = len(hoeken.run().t) * len(hoeken.sweep(vary=VARY, samples=1, rows=True).columns)
    assert 4e7 < usual(10**9, rows=True) * numbers <= 1e8
    assert usual(10, rows=True, every=1e-6) == 1


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
    # where nothing is said, shares are as large as they are in the folder
    assert mechc.ray.sweep(hoeken, out=tmp_path, **OPTIONS).ranges == first.ranges
    with pytest.raises(mechc.UsageError, match="another sweep: `share` is 60 there, and 50 here"):
        mechc.ray.sweep(hoeken, out=tmp_path, share=50, **OPTIONS)
    told = json.loads((tmp_path / "sweep.json").read_text())
    assert told["variants"] == 240 and told["mechanism"] == "hoeken"
    with pytest.raises(mechc.UsageError, match="another sweep: `seed` is 3 there, and 4 here"):
        mechc.ray.sweep(hoeken, out=tmp_path, share=60, **{**OPTIONS, "seed": 4})
    # the same text elsewhere is the same
    (tmp_path / "copy.mech").write_text(hoeken.text)
    for same in (mechc.load(tmp_path / "copy.mech"), mechc.parse(hoeken.text)):
        assert mechc.ray.sweep(same, out=tmp_path, share=60, **OPTIONS).made == 0
    with pytest.raises(mechc.UsageError, match="`text` is another"):
        mechc.ray.sweep(mechc.parse(hoeken.text + " "), out=tmp_path, share=60, **OPTIONS)


@pytest.mark.timeout(280)
def test_variants_of_a_file_and_a_file_system_that_is_given(local_ray, hoeken, tmp_path):
    import pyarrow.fs

    table = tmp_path / "variants.csv"
    table.write_text("base [mm]\n" + "\n".join(map(str, range(80, 90))) + "\n")
    options = {"variants": table, "results": OPTIONS["results"]}
    whole = pa.table(hoeken.sweep(**options))
    system = pyarrow.fs.SubTreeFileSystem(str(tmp_path), pyarrow.fs.LocalFileSystem())
    found = mechc.ray.sweep(hoeken, out="within", filesystem=system, share=4, **options)
    assert found.made == 3 and len(os.listdir(tmp_path / "within")) == 4
    assert found.to_arrow().combine_chunks().equals(whole.combine_chunks())
    with pytest.raises(mechc.UsageError, match="`filesystem` is an object of str"):
        mechc.ray.sweep(hoeken, out="within", filesystem="here", **options)


def test_a_share_is_counted_from_the_first_variant_of_its_sweep(hoeken):
    import pickle

    sweep = hoeken.sweep(skip=100, take=50, **OPTIONS)
    batches = list(mechc.ray.share(pickle.dumps(sweep), 10, 20))
    assert pa.Table.from_batches(batches)["variant"].to_pylist() == list(range(110, 120))
    for wrong in ((-5, 20), (40, 51), (20, 10)):
        with pytest.raises(mechc.UsageError):
            list(mechc.ray.share(pickle.dumps(sweep), *wrong))


def test_what_is_no_folder_of_a_sweep(hoeken, tmp_path):
    file = tmp_path / "file"
    file.write_text("mine")
    with pytest.raises(mechc.FileError):
        mechc.ray.sweep(hoeken, out=file, **OPTIONS)
    with pytest.raises(mechc.UsageError, match="nope"):
        mechc.ray.sweep(hoeken, out="nope://x/y", **OPTIONS)
    for contents in ("{", "[]", "{}", '{"share": 0}', '{"share": "x"}'):
        (tmp_path / "sweep.json").write_text(contents)
        with pytest.raises(mechc.UsageError, match="says nothing of a sweep"):
            mechc.ray.sweep(hoeken, out=tmp_path, **OPTIONS)
    with pytest.raises(mechc.UsageError, match="no mechanism"):
        mechc.ray.sweep(3, out=tmp_path, **OPTIONS)
    assert file.read_text() == "mine"


def test_files_of_a_place_with_a_query():
    shares = mechc.ray.Shares("s3://bucket/x?region=here", 2, ((0, 2),), 1)
    assert shares.files == ["s3://bucket/x/part-000000000000-000000000002.parquet?region=here"]


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
