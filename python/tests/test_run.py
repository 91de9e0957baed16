"""Runs have the columns, units and bits of the command."""

from __future__ import annotations

import errno
import json
import os
import pickle
import warnings

import numpy as np
import pytest
from conftest import EXAMPLES, OTHER_SIDE, ROOT, command, same_bits

import mechc

CASES = sorted(path for folder in ("cases", "cases_composed", "cases_forces") for path in (ROOT / "tests" / folder).glob("**/*.mech"))


def mechanism_of(path):
    """The one that is no part of another, as the command asks for where a file has several."""
    return mechc.load(path)


@pytest.mark.filterwarnings("ignore::mechc.MechcWarning")
@pytest.mark.parametrize("path", [*EXAMPLES, *CASES], ids=lambda path: path.stem)
def test_bits_of_the_command(path):
    times = ["--at", "0", "--at", "0.01"] if "analysis" not in path.read_text() else []
    ended = command("run", str(path), *times)
    try:
        m = mechc.load(path)
        run = m.run(at=[0, 0.01] if times else None, strict=False)
    except mechc.MechcError as error:
        kind = {1: mechc.InputError, 2: mechc.UsageError, 3: mechc.AnalysisError, 4: mechc.FileError}[ended.code]
        assert isinstance(error, kind)
        assert error.code in ended.err
        return
    assert (ended.code == 0) == (run.status == "ok"), ended.err
    table = ended.table()
    assert run.columns == list(table)
    for name, cells in table.items():
        assert same_bits(run[name], cells), name


def test_options_are_those_of_the_command(tmp_path):
    m = mechc.load(ROOT / "examples/slider_crank.mech")
    run = m.run(rod_length="180 mm", every="0.5 ms", columns=["travel*"], results={"stroke": "max(travel) - min(travel)"})
    results = tmp_path / "results.json"
    ended = command(
        "run", "examples/slider_crank.mech", "--set", "rod_length=180mm", "--every", "0.5ms", "--columns", "travel*",
        "--result", "stroke = max(travel) - min(travel)", "--results", str(results),
    )
    assert ended.code == 0
    table = ended.table()
    assert run.columns == list(table) == ["t", "travel", "travel.d", "travel.dd"]
    assert all(same_bits(run[name], cells) for name, cells in table.items())
    assert run.results == json.loads(results.read_text())
    assert run.units == {"t": "s", "travel": "m", "travel.d": "m/s", "travel.dd": "m/s^2"}


def test_numbers_are_si_and_texts_have_units():
    m = mechc.load(ROOT / "examples/slider_crank.mech")
    assert m.params["rod_length"] == 0.15 and m.units["rod_length"] == "m"
    runs = [m.run(rod_length=value) for value in (0.18, "180 mm", np.float64(0.18), "0.18 m")]
    runs.append(m.run(set={"rod_length": "18 cm"}))
    assert len({run["piston.x"].tobytes() for run in runs}) == 1


def test_arrays_share_memory_and_cannot_be_written_to():
    run = mechc.load(ROOT / "examples/slider_crank.mech").run()
    x = run["piston.x"]
    assert x.dtype == np.float64 and not x.flags.owndata and not x.flags.writeable
    with pytest.raises(ValueError):
        x[0] = 1.0
    again = np.asarray(run._table.column(run.columns.index("piston.x")))
    assert again.__array_interface__["data"] == x.__array_interface__["data"]


def test_a_table_is_an_array_of_all_its_columns():
    m = mechc.load(ROOT / "examples/slider_crank.mech")
    run = m.run(every="10 ms")
    wanted = np.column_stack([run[name] for name in run.columns])
    found = np.asarray(run)
    assert found.dtype == np.float64 and found.shape == run.shape and same_bits(found, wanted)
    assert np.asarray(run, dtype=np.float32).dtype == np.float32 and np.array(run).flags.writeable
    if int(np.__version__.split(".")[0]) >= 2:
        with pytest.raises(ValueError, match="side by side they are a copy"):
            np.asarray(run, copy=False)
    # words are among the columns of a sweep, which stay in their places
    swept = m.sweep({"rod_length": [0.14, 0.15]}, results={"top": "max(travel)"}).read()
    assert np.asarray(swept)[:, swept.columns.index("status")].tolist() == ["ok", "ok"] and np.asarray(swept).shape == swept.shape


def test_frames_are_made_of_a_table():
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    m = mechc.load(ROOT / "examples/slider_crank.mech")
    swept = m.sweep({"rod_length": [0.14, 0.15]}, results={"top": "max(travel)"}).read()
    for table in (m.run(every="10 ms"), m.reactions(every="10 ms"), swept):
        # what pandas takes for a table of columns are dictionaries alone; of all else it takes the array
        frames = [pandas.DataFrame(table, columns=table.columns), pandas.DataFrame(dict(table)), table.to_pandas(), polars.DataFrame(table)]
        for frame in frames:
            assert list(frame.columns) == table.columns and frame.shape == table.shape
            assert all(frame[name].to_numpy().tolist() == table[name].tolist() for name in table if name != "stopped")
        assert pandas.DataFrame(table).shape == table.shape


def test_what_a_table_gives_changes_nothing_of_it():
    m = mechc.load(ROOT / "examples/slider_crank.mech")
    run = m.run(every="10 ms", results={"top": "max(travel)"})
    for again in (run, pickle.loads(pickle.dumps(run))):
        kept = again.results, again.result_units, again.units, again.columns, again.to_dict()
        for given in (again.results, again.result_units, again.units, again.columns, again.to_dict()):
            given.clear()
        assert all(given for given in kept)
        assert (again.results, again.result_units, again.units, again.columns) == kept[:4] and list(again.to_dict()) == list(kept[4])
    swept = m.sweep({"rod_length": [0.14]}, results={"top": "max(travel)"}).read()
    with pytest.raises(ValueError):
        swept["status"][0] = "E0602"
    assert swept.to_pandas()["status"].tolist() == ["ok"]


def test_names_that_are_none_are_refused_in_words():
    run = mechc.load(ROOT / "examples/slider_crank.mech").run(every="10 ms")
    for name in (["travel"], {"travel"}, 3, None):
        with pytest.raises(KeyError, match="there is no column .*; several columns are `to_numpy"):
            run[name]
        assert name not in run


def test_a_lock_up_has_what_there_is():
    m = mechc.load(ROOT / "examples/slider_crank.mech")
    with pytest.raises(mechc.LockUp) as caught:
        m.run(rod_length="48 mm")
    error = caught.value
    ended = command("run", "examples/slider_crank.mech", "--set", "rod_length=48 mm")
    wanted = ended.err.strip().replace("examples/slider_crank.mech", str(ROOT / "examples/slider_crank.mech"))
    assert str(error).splitlines()[0] == wanted.splitlines()[0]
    assert "`motor`" in str(error) and error.code == "E0602"
    assert error.time == pytest.approx(0.004859977255)
    assert error.diagnostics[0]["labels"][0]["start"]["line"] == 36
    partial = error.partial
    assert partial.status == "E0602" and partial.rows == len(ended.table()["t"])
    run = m.run(rod_length="48 mm", strict=False)
    assert run.status == "E0602" and run.stopped == error.time


def test_errors_say_who_is_to_mend_what():
    with pytest.raises(mechc.InputError) as caught:
        mechc.parse("mechanism m { body a { point P = (1 m, 0) } driver d: angle(b) = t }")
    assert caught.value.diagnostics[0]["code"] == "E0201"
    assert "mechanism.mech:1" in str(caught.value)
    m = mechc.load(ROOT / "examples/slider_crank.mech")
    with pytest.raises(mechc.UsageError, match="was `rod_length` meant"):
        m.run(rod_lenght=1)
    with pytest.raises(ValueError):
        m.run(rod_length=float("nan"))
    with pytest.raises(mechc.UsageError):
        m.run(rod_length="60 s")
    with pytest.raises(mechc.FileError) as caught:
        mechc.load("nowhere.mech")
    assert isinstance(caught.value, OSError)
    with pytest.raises(KeyError, match="was `travel` meant"):
        m.run()["travl"]


def test_files_that_are_not_there_say_which_and_why(tmp_path):
    m, missing = mechc.load(ROOT / "examples/slider_crank.mech"), tmp_path / "nowhere.mech"
    asks = [
        (lambda: mechc.load(missing), errno.ENOENT, missing),
        (lambda: mechc.load(tmp_path), errno.EISDIR, tmp_path),
        (lambda: m.sweep(variants=missing), errno.ENOENT, missing),
        (lambda: m.to_latex(tmp_path), errno.EISDIR, tmp_path),
    ]
    for ask, number, name in asks:
        with pytest.raises(OSError) as caught:
            ask()
        for error in (caught.value, pickle.loads(pickle.dumps(caught.value))):
            assert isinstance(error, mechc.FileError)
            assert (error.errno, error.filename, error.strerror) == (number, str(name), os.strerror(number))


def test_what_no_way_leads_to_is_reassembled_and_says_so():
    m = mechc.parse(OTHER_SIDE)
    sweep = m.sweep({"turned": [1.0, 5.2]}, results={"most": "max(high)"})
    found = sweep.read()
    assert list(found["status"]) == ["ok", "reassembled"]
    for variant, status in enumerate(found["status"]):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            run = m.run(lead=True, set=sweep.settings(variant), results={"most": "max(high)"})
        assert run.status == status and run.error is None and run.results["most"] == found["most"][variant]
        assert pickle.loads(pickle.dumps(run)).status == status
        assert [one for one in told if "E0612" in str(one.message)] == (told[:1] if status == "reassembled" else [])
    # `at` is asked for a place on the branch
    with pytest.raises(mechc.AnalysisError, match="E0612"):
        m.at(turned=5.2)


def test_texts_with_files():
    leg = (ROOT / "examples/jansen_leg.mech").read_text()
    text = """use "legs/jansen_leg.mech"
        mechanism one { input turn = 60 rpm * t part leg: jansen_leg(turn = turn) at (0, 0, 0)
            measure low = y(leg.foot.toe) analysis from 0 s to 1 s every 0.1 s }"""
    m = mechc.parse(text, files={"legs/jansen_leg.mech": leg}, mechanism="one")
    assert m.run().rows == 11 and list(m.inputs) == ["turn"]
    with pytest.raises(mechc.InputError):
        mechc.parse(text, mechanism="one")
