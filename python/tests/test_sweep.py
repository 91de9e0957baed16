"""Sweeps have the bits of the command, whoever reads them."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest
from conftest import ROOT, command, same_bits

import mechc

HOEKEN = ROOT / "examples/hoeken.mech"
FLAT = {"flatness": "max(deviation) - min(deviation)"}
AS_OPTION = ["--result", "flatness = max(deviation) - min(deviation)"]


@pytest.fixture(scope="module")
def crank():
    return mechc.load(ROOT / "examples/slider_crank.mech")


def held_against(frame, table):
    assert list(frame) == list(table)
    for name, cells in table.items():
        if name == "status":
            assert list(frame[name]) == cells
        elif name == "variant":
            assert list(frame[name]) == [int(cell) for cell in cells]
        else:
            assert same_bits(np.asarray(frame[name]), cells), name


@pytest.mark.parametrize(
    "vary, more, options",
    [
        ({"base": mechc.between("60 mm", "220 mm", 9)}, {}, ["--vary", "base=60mm..220mm:9"]),
        ({"base": [0.06, 0.08, 0.2]}, {}, ["--vary", "base=60mm,80mm,200mm"]),
        ({"base": ["60 mm", "0.2 m"]}, {}, ["--vary", "base=60 mm,0.2 m"]),
        (
            {"base": mechc.between("60 mm", "100 mm"), "arm": mechc.between(0.09, 0.12)},
            {"samples": 12, "seed": 7},
            ["--vary", "base=60mm..100mm", "--vary", "arm=90mm..120mm", "--sample", "12", "--seed", "7"],
        ),
        (
            {"base": mechc.between("60 mm", "100 mm")},
            {"samples": 5, "method": "random", "skip": 1, "take": 3},
            ["--vary", "base=60mm..100mm", "--sample", "5", "--method", "random", "--skip", "1", "--take", "3"],
        ),
        (
            {"base": mechc.between("60 mm", "100 mm", 9)},
            {"until": "flatness > 37"},
            ["--vary", "base=60mm..100mm:9", "--until", "flatness > 37"],
        ),
    ],
)
def test_bits_of_the_command(vary, more, options):
    sweep = mechc.load(HOEKEN).sweep(vary=vary, results=FLAT, **more)
    ended = command("sweep", str(HOEKEN), *options, *AS_OPTION)
    held_against(sweep.read(), ended.table())


def test_rows():
    m = mechc.load(HOEKEN)
    options = {"rows": True, "columns": ["pen_?", "pen_x.d"], "every": "0.5 s"}
    sweep = m.sweep(vary={"base": mechc.between("60 mm", "180 mm", 5)}, **options)
    ended = command(
        "sweep", str(HOEKEN), "--vary", "base=60mm..180mm:5", "--rows", "--columns", "pen_?", "--columns", "pen_x.d",
        "--every", "0.5s",
    )
    held_against(sweep.read(), ended.table())


def test_a_table_of_variants(tmp_path):
    m = mechc.load(HOEKEN)
    variants = {"base": np.array([0.06, 0.08]), "speed": np.array([3.0, 4.0])}
    file = tmp_path / "variants.csv"
    file.write_text("base [mm],speed [rad/s]\n60,3\n80,4\n")
    wanted = m.sweep(variants=file, results=FLAT).read()
    for table in (variants, pd.DataFrame(variants), pl.DataFrame(variants)):
        found = m.sweep(variants=table, results=FLAT).read()
        assert list(found) == list(wanted)
        assert all(found[name].tobytes() == wanted[name].tobytes() for name in wanted if name != "status")
    ended = command("sweep", str(HOEKEN), "--vary", f"@{file}", *AS_OPTION)
    held_against(wanted, ended.table())


def test_whatever_speaks_arrow():
    sweep = mechc.load(HOEKEN).sweep(vary={"base": mechc.between("60 mm", "220 mm", 9)}, results=FLAT)
    wanted = sweep.read()
    frame, table = pl.DataFrame(sweep), pa.table(sweep)
    assert frame["flatness"].null_count() == table["flatness"].null_count == 4
    assert frame["status"].to_list() == table["status"].to_pylist() == list(wanted["status"])
    assert same_bits(frame["flatness"].fill_null(np.nan).to_numpy(), wanted["flatness"])
    assert table.schema.field("base").metadata == {b"unit": b"m"}
    assert list(sweep.to_pandas()["stopped"].isna()) == [True] * 5 + [False] * 4
    assert sweep.summary["ok"] == (5, 0) and sweep.summary["E0602"] == (1, 6)
    batches = pa.RecordBatchReader.from_stream(sweep)
    assert sum(batch.num_rows for batch in batches) == 9


def test_settings_of_a_variant_run_to_the_same_bits():
    m = mechc.load(HOEKEN)
    sweep = m.sweep(vary={"base": mechc.between("60 mm", "100 mm", 9)}, results=FLAT)
    found = sweep.read()["flatness"][3]
    assert m.run(lead=True, set=sweep.settings(3), results=FLAT).results["flatness"] == found
    # what is set for all variants is theirs too
    sweep = m.sweep(vary={"arm": ["95 mm", "96 mm"]}, set={"base": "90 mm"}, results=FLAT)
    assert sweep.settings(1) == {"base": "90 mm", "arm": "0.096 m"}
    assert m.run(lead=True, set=sweep.settings(1), results=FLAT).results["flatness"] == sweep.read()["flatness"][1]


def test_copies_of_copies_vary_by_their_names():
    m, name = mechc.load(ROOT / "examples/engine.mech"), "cylinder[0,1].rod_length"
    results = {"most": "max(shake_y)"}
    wanted = m.sweep({name: ["130 mm", "140 mm"]}, to=0.002, results=results).read()["most"]
    for options in ({"vary": {name: np.array([0.13, 0.14])}}, {"variants": pl.DataFrame({name: [0.13, 0.14]})}):
        assert np.array_equal(m.sweep(**options, to=0.002, results=results).read()["most"], wanted)
    with pytest.raises(mechc.MechcError, match="no parameter"):
        mechc.load(HOEKEN).sweep(vary={"\ufeffbase": [0.08]})


@pytest.mark.parametrize("option", [{"by": "base"}, {"reactions": True}, {"columns": "pen_x"}])
def test_what_rows_alone_have_wants_rows(option):
    with pytest.raises(mechc.UsageError, match="rows=True"):
        mechc.load(HOEKEN).sweep(vary={"base": [0.08]}, **option)


def test_shares_are_the_whole_and_jobs_change_nothing():
    m = mechc.load(HOEKEN)
    vary = {"base": mechc.between("60 mm", "100 mm", 40)}
    whole = m.sweep(vary=vary, results=FLAT, jobs=1).read()
    shares = [m.sweep(vary=vary, results=FLAT, skip=k, take=13, jobs=3).read() for k in range(0, 40, 13)]
    for name in ("variant", "base", "flatness"):
        assert np.array_equal(np.concatenate([share[name] for share in shares]), whole[name])


def test_progress():
    told = []
    m = mechc.load(HOEKEN)
    m.sweep(vary={"base": mechc.between("60 mm", "100 mm", 9)}, results=FLAT, progress=lambda *done: told.append(done)).read()
    assert told[-1] == (9, 9)
    with pytest.MonkeyPatch.context() as patch:
        # as in programs without a console
        patch.setattr("sys.stderr", None)
        assert len(m.sweep(vary={"base": [0.06]}, results=FLAT, progress=True).read()["base"]) == 1

    def broken(done, count):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        m.sweep(vary={"base": [0.06]}, results=FLAT, progress=broken).read()


def test_what_cannot_vary_is_told():
    m = mechc.load(HOEKEN)
    for vary in ({"bse": [0.1]}, {"base": []}, {"base": [float("nan")]}, {}, None, {"base": mechc.between("1 mm", "2 mm")}, {3: [1]}):
        with pytest.raises(mechc.UsageError):
            m.sweep(vary=vary)


def test_a_stream_that_several_threads_read_is_read_once():
    sweep = mechc.load(HOEKEN).sweep({"base": mechc.between("60 mm", "100 mm")}, samples=600, rows=True, columns="t", jobs=1)
    reader = pa.RecordBatchReader.from_stream(sweep)

    def read(_):
        return [list(batch["variant"].to_numpy()) for batch in reader]

    with ThreadPoolExecutor(4) as threads:
        found = [number for batches in threads.map(read, range(4)) for batch in batches for number in batch]
    rows = mechc.load(HOEKEN).run(columns="t").rows
    assert sorted(found) == [number for number in range(600) for _ in range(rows)]


def test_what_is_missing_is_null_in_polars():
    sweep = mechc.load(HOEKEN).sweep({"base": [0.06, 0.2]}, results=FLAT)
    frames = [sweep.to_polars(), sweep.read().to_polars(), pl.DataFrame(sweep)]
    assert [frame["stopped"].null_count() for frame in frames] == [frames[2]["stopped"].null_count()] * 3
    assert frames[2]["stopped"].null_count() > 0


def test_what_is_told_of_a_mechanism_is_nobodys_to_change():
    m = mechc.load(HOEKEN)
    known = dict(m.params)
    m.params["base"] = 999.0
    m.columns.clear()
    m.units["base"] = "ft"
    assert m.params == known and "t" in m.columns and m.units["base"] == "m"
    with pytest.raises(AttributeError):
        m.params = {}


@pytest.mark.parametrize("kind", [str, object, "both"])
def test_arrays_of_texts_are_lists_of_them(kind):
    m = mechc.load(ROOT / "examples/slider_crank.mech")
    texts = ["140 mm", "0.15 m"]
    values = np.array([*texts, 0.16], dtype=object) if kind == "both" else np.array(texts, dtype=kind)
    lengths = m.sweep({"rod_length": values}, results={"top": "max(travel)"}).read()["rod_length"]
    assert lengths.tolist() == m.sweep({"rod_length": values.tolist()}, results={"top": "max(travel)"}).read()["rod_length"].tolist()
    assert lengths.tolist() == [0.14, 0.15, 0.16][: len(values)]


def test_arrays_of_what_is_neither_are_refused():
    m = mechc.load(ROOT / "examples/slider_crank.mech")
    masked = np.ma.masked_array(["140 mm", "150 mm"], mask=[False, True])
    odd = [(np.array([["140 mm"]]), "one of one dimension"), (np.array([], dtype=str), "varies over no value"), (masked, "masked")]
    odd += [(np.array(["140 mm", None], dtype=object), "is no number"), (np.array([b"140 mm"]), "is no number")]
    for values, why in odd:
        with pytest.raises(mechc.UsageError, match=why):
            m.sweep({"rod_length": values})


def test_axes_keep_their_order_however_they_are_written(crank):
    for rods in ([0.16, 0.17], ["160 mm", "170 mm"], mechc.between(0.16, 0.17, 2)):
        swept = crank.sweep({"rod_length": rods, "crank_length": mechc.between(0.04, 0.05, 2)}).read()
        assert swept.columns[:3] == ["variant", "rod_length", "crank_length"]
        assert swept["crank_length"].tolist() == [0.04, 0.05, 0.04, 0.05]
    with pytest.raises(mechc.MechcError) as error:
        crank.sweep({"rodlength": [0.1]})
    assert "vary rodlength" in str(error.value)


def test_a_sweep_of_a_file_stays_what_it_is(crank, tmp_path):
    file = tmp_path / "v.csv"
    file.write_text("rod_length [mm]\n160\n170\n")
    sweep = crank.sweep(variants=file)
    packed, before = pickle.dumps(sweep), sweep.read()["rod_length"].tolist()
    file.write_text("rod_length [mm]\n180\n")
    assert before == [0.16, 0.17] and pickle.loads(packed).read()["rod_length"].tolist() == before
    file.write_text("rod_length [deg]\n180\n")
    with pytest.raises(mechc.MechcError, match="v.csv"):
        crank.sweep(variants=file)
    with pytest.raises(mechc.FileError):
        crank.sweep(variants=tmp_path / "none.csv")


def test_a_summary_is_of_the_stream_that_was_begun_last(crank):
    sweep = crank.sweep({"rod_length": mechc.between(0.16, 0.2, 20_000)})
    older = pa.RecordBatchReader.from_stream(sweep)
    older.read_next_batch()
    sweep.read()
    older.read_next_batch()
    assert sweep.summary == {"ok": (20_000, 0)}
