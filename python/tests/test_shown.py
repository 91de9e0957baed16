"""What is for people: notebooks, pages, plots, files; and tables of derivatives and tolerances."""

from __future__ import annotations

import copy
import dataclasses
import html
import json
import os
import pickle
import re
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from conftest import EXAMPLES, ROOT, command, same_bits

import mechc

CRANK = ROOT / "examples/slider_crank.mech"
PEAK = {"peak": "max(abs(der(der(travel))))"}


@pytest.mark.filterwarnings("ignore::mechc.MechcWarning")
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_a_notebook_shows_the_page_in_a_frame(path):
    m = mechc.load(path)
    if m.analysis is None:
        # what it is, and why nothing moves
        text = m._repr_html_()
        assert m.name in text and "analysis" in text and "<iframe" not in text
        return
    text = m._repr_html_()
    assert len(text.encode()) <= 300_000
    if path.stem == "walker":
        # so many bodies do not fit into a page of that size
        assert "<svg" in text and "<iframe" not in text
        return
    frame = re.search(r"<iframe ([^>]*)>", text)
    # an origin of its own: scripts run, and reach nothing of the notebook
    assert frame and 'sandbox="allow-scripts"' in frame[1] and "allow-same-origin" not in text
    assert "<noscript><svg" in text.replace("\n", "") or "<noscript><?xml" in text


@pytest.mark.timeout(200)
def test_a_notebook_runs(monkeypatch):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    notebook = nbformat.read(ROOT / "python/examples/notebook.ipynb", as_version=4)
    done = nbclient.NotebookClient(notebook, timeout=150, resources={"metadata": {"path": str(ROOT)}}).execute()
    outputs = [output for cell in done.cells if cell.cell_type == "code" for output in cell.outputs]
    kinds = {kind for output in outputs for kind in output.get("data", {})}
    assert {"text/html", "image/png"} <= kinds
    assert not [output for output in outputs if output.output_type == "error"]


def test_plots():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    run = mechc.load(CRANK).run()
    ax = run.plot("travel", "travel.dd")
    assert len(ax.figure.axes) == 2 and np.array_equal(ax.get_lines()[0].get_ydata(), run["travel"])
    assert len(run.plot().figure.axes) == 2
    with pytest.raises(KeyError, match="was `travel` meant"):
        run.plot("travl")
    with pytest.raises(mechc.UsageError, match="do not go into one plot"):
        run.plot("travel", "travel.d", "travel.dd")
    for columns in (["travel", "travel.dd"], ("travel", "travel.dd"), np.array(["travel", "travel.dd"])):
        assert [line.get_label() for axis in run.plot(columns).figure.axes for line in axis.get_lines()] == ["travel", "travel.dd"]
    with pytest.raises(KeyError, match="was `travel` meant"):
        run.plot(["travl"])
    for nothing in ([], None, ()):
        with pytest.raises(mechc.UsageError, match="holds no name"):
            run.plot(nothing)
    with pytest.raises(mechc.UsageError, match="`columns` has 3, and texts are wanted"):
        run.plot(["travel", 3])


def test_files_are_those_of_the_command(tmp_path):
    m = mechc.load(CRANK)
    for name, write, options in (
        ("a.rs", m.to_rust, []),
        ("a.tex", m.to_latex, []),
        ("a.json", m.to_json, []),
    ):
        written = write(tmp_path / name).read_text()
        wanted = tmp_path / f"wanted-{name}"
        assert command("emit", str(CRANK), "-o", str(wanted), *options).code == 0
        assert written == wanted.read_text()
    page, picture = m.view(tmp_path / "a.html"), m.view(tmp_path / "a.svg")
    assert page.read_text().lstrip().startswith("<!") and "<svg" in picture.read_text()
    with pytest.raises(mechc.UsageError):
        m.view(tmp_path / "a.png")


@pytest.mark.skipif(os.name != "posix", reason="links, rights and pipes")
def test_what_is_written_leaves_the_place_what_it_is(tmp_path):
    m = mechc.load(CRANK)
    own, link, pipe = tmp_path / "own.tex", tmp_path / "link.tex", tmp_path / "pipe.tex"
    own.touch(mode=0o600)
    link.symlink_to(own.name)
    m.to_latex(link)
    wanted = m.to_latex()
    assert link.is_symlink() and own.read_text() == wanted and own.stat().st_mode & 0o777 == 0o600
    os.mkfifo(pipe)
    with ThreadPoolExecutor(1) as reader:
        read = reader.submit(pipe.read_text)
        m.to_latex(pipe)
        assert read.result() == wanted and pipe.is_fifo()
    own.chmod(0o400)
    with pytest.raises(mechc.FileError, match="Permission denied"):
        m.to_json(own)
    assert own.read_text() == wanted and sorted(os.listdir(tmp_path)) == ["link.tex", "own.tex", "pipe.tex"]


def test_a_crate_spares_what_others_wrote(tmp_path):
    m = mechc.load(CRANK)
    folder = m.to_rust(tmp_path / "crank")
    assert (folder / "Cargo.toml").exists() and m.to_rust(folder) == folder
    (folder / "Cargo.toml").write_text("[package]\n")
    with pytest.raises(mechc.FileError, match="did not write"):
        m.to_rust(folder)


def test_jacobians_are_those_of_the_command():
    m = mechc.load(CRANK)
    j = m.jacobian(by=["rod_length", "speed"], results=PEAK)
    table = command("run", str(CRANK), "--by", "rod_length", "--by", "speed").table()
    assert j["travel"].shape == (81, 2) and j.results.shape == (1, 2) and j.result_names == ["peak"]
    for k, name in enumerate(("rod_length", "speed")):
        assert same_bits(np.ascontiguousarray(j["travel"][:, k]), table[f"travel.by.{name}"])
    f = m.objective("peak", by=["rod_length"], results=PEAK)
    value, gradient = f(f.x0)
    assert value == m.run(results=PEAK).results["peak"] and gradient[0] == j.results[0, 0]
    h = 1e-6
    assert gradient[0] == pytest.approx((f.value(f.x0 + h) - f.value(f.x0 - h)) / (2 * h), rel=1e-5)
    # a value does not depend on those that were asked for before
    assert f([0.2])[0] == m.objective("peak", by=["rod_length"], results=PEAK)([0.2])[0]
    assert m.objective("peak", by=["rod_length"], results=PEAK, failed=np.inf)([0.01])[0] == np.inf
    with pytest.raises(mechc.AnalysisError):
        f([0.01])


def test_a_gradient_belongs_to_who_gets_it():
    f = mechc.load(CRANK).objective("peak", by=["rod_length"], results=PEAK)
    _, gradient = f(f.x0)
    kept = gradient.copy()
    gradient *= -0.1
    assert same_bits(f.gradient(f.x0), kept)


def test_what_has_no_derivative_or_no_value_is_said():
    # where the valve opens, which goes with the rod
    f = mechc.load(ROOT / "examples/compressor.mech").objective("peak", by=["rod_length"])
    assert np.isfinite(f.value(f.x0))
    with pytest.raises(mechc.AnalysisError, match="`peak` has no derivative by `rod_length`"):
        f(f.x0)
    nothing = {"odd": "at(travel, 0 s) / (at(travel, 0 s) - at(travel, 0 s))"}
    with pytest.raises(mechc.AnalysisError, match="`odd` has no value"):
        mechc.load(CRANK).objective("odd", by=["rod_length"], results=nothing)([0.15])
    assert mechc.load(CRANK).objective("odd", by=["rod_length"], results=nothing, failed=7.0)([0.15])[0] == 7.0


def test_the_peak_of_a_torque_has_its_gradient():
    f = mechc.load(ROOT / "examples/shaper_torque.mech").objective("most", by=["crank_length"])
    _, gradient = f(f.x0)
    assert gradient[0] == pytest.approx((f.value(f.x0 + 1e-6) - f.value(f.x0 - 1e-6)) / 2e-6, rel=1e-7)


def test_residuals_of_a_mechanism_with_results():
    m = mechc.load(ROOT / "examples/jansen_leg.mech")
    assert m.results
    f = m.residuals(["foot.x"], [0.0, 0.0], by=["la"], at=[0.0, 0.1])
    assert f(f.x0).shape == (2,) and np.isfinite(f.jacobian(f.x0)).all()


def test_what_is_optimised_is_told_its_inputs():
    m = mechc.load(ROOT / "examples/parallel_robot.mech")
    told, far = {"swing": "20 deg * sin(1 rev/s * t)"}, {"far": "max(x(platform.C))"}
    f = m.objective("far", by=["base_radius"], results=far, inputs=told)
    value, gradient = f(f.x0)
    assert value == m.run(results=far, inputs=told).results["far"] != m.run(results=far).results["far"]
    assert gradient[0] == pytest.approx((f.value(f.x0 + 1e-6) - f.value(f.x0 - 1e-6)) / 2e-6, rel=1e-7)
    turned = m.run(at=[0.2], inputs=told)["tilt"]
    r = m.residuals(["tilt"], turned, by=["base_radius"], at=[0.2], inputs=told)
    assert r(r.x0) == pytest.approx([0.0], abs=1e-12)


LEG = """
mechanism leg {
    param r = 40 mm
    param half = r / 2
    input theta = 0.1 + 1 rad/s * t
    ground { point O = (0, 0) }
    body by at (0, 0, 0.1) {
        point O = (0, 0)
        point P = (r + half, 0)
    }
    joint by_hand: revolute(ground.O, by.O)
    driver motor: rotation(by_hand) = theta
    analysis from 0 s to 1 s every 0.5 s
}"""

LEGS = """
use "leg.mech"
mechanism legs {
    param w = 1 rad/s
    part one: leg(theta = 0.2 + w * t)
    measure py = y(one.by.P)
    result top = max(py)
    analysis from 0 s to 1 s every 0.5 s
}"""


def test_a_body_may_be_called_as_derivatives_are():
    def legs(name):
        leg = LEG.replace("by.", f"{name}.").replace("body by", f"body {name}")
        return mechc.parse(LEGS.replace("one.by", f"one.{name}"), files={"leg.mech": leg})

    by, bar = [legs(name).jacobian(by=["w", "one.r"]) for name in ("by", "bar")]
    assert by.by == bar.by == ["w", "one.r"] and by.results.shape == (1, 2)
    assert same_bits(by.results, bar.results) and same_bits(by["py"], bar["py"])
    leg = LEG.replace("body by", "body bar").replace(" by.O", " bar.O").replace("by_hand", "by")
    joint = mechc.parse(LEGS.replace("one.by", "one.bar"), files={"leg.mech": leg})
    assert joint.reactions().columns == ["t", "one.by.fx", "one.by.fy", "one.motor.effort"]


def test_what_is_optimised_begins_with_what_is_set():
    m = mechc.parse(LEG)
    f = m.residuals("by.x", np.zeros(3), by="half", r=0.06)
    assert list(f.x0) == [0.03] and same_bits(f(f.x0), m.run(r=0.06, lead=True)["by.x"])
    with pytest.raises(mechc.UsageError, match="`half` is set"):
        m.residuals("by.x", np.zeros(3), by="half", half=0.06)


def test_residuals_are_of_nobody_else():
    m, wanted = mechc.load(CRANK), np.zeros(3)
    times = [0.0, 0.01, 0.02]
    f = m.residuals(["travel"], wanted, by=(name for name in ["rod_length"]), at=(time for time in times))
    values, slopes = f(f.x0).copy(), f.jacobian(f.x0).copy()
    wanted += 1.0
    f.jacobian(f.x0)[:] = 0.0
    again = pickle.loads(pickle.dumps(f))
    for kept in (f, again):
        assert same_bits(kept(kept.x0), values) and same_bits(kept.jacobian(kept.x0), slopes)
    with pytest.raises(mechc.UsageError, match="of which columns"):
        m.residuals([], wanted, by="rod_length", at=times)


def test_letters_with_marks_are_one_letter_or_two():
    m = mechc.parse(LEG.replace("half", "m\u00e4\u00df"))
    assert same_bits(m.run(**{"ma\u0308\u00df": 0.03})["by.phi"], m.run(set={"m\u00e4\u00df": 0.03})["by.phi"])
    assert m.jacobian(by=["ma\u0308\u00df"]).by == ["m\u00e4\u00df"]


def test_residuals_have_exact_derivatives():
    m = mechc.load(CRANK)
    f = m.residuals(["travel", "lean"], np.zeros((3, 2)), by=["rod_length", "crank_length"], at=[0.0, 0.01, 0.02])
    slopes = f.jacobian(f.x0)
    assert f(f.x0).shape == (6,) and slopes.shape == (6, 2)
    for k in range(2):
        step = np.eye(2)[k] * 1e-7
        assert slopes[:, k] == pytest.approx((f(f.x0 + step) - f(f.x0 - step)) / 2e-7, rel=1e-5, abs=1e-6)
    with pytest.raises(mechc.UsageError, match="do not rise"):
        m.residuals(["travel"], [0.0, 0.0], by=["rod_length"], at=[0.01, 0.0])


def test_tolerances_are_those_of_the_command():
    found = mechc.load(CRANK).tolerance({"rod_length": "0.05 mm", "crank_length": ("-0.02 mm", 0)}, results=PEAK, verify=True)
    ended = command(
        "tolerance", str(CRANK), "--tol", "rod_length=0.05mm", "--tol", "crank_length=-0.02mm..0mm",
        "--result", "peak = max(abs(der(der(travel))))", "--verify", "-o", "/dev/stdout", "--format", "json",
    )
    assert ended.code == 0, ended.err
    told = json.dumps(json.loads(ended.out))
    for deviation in found.deviations.values():
        for number in (deviation.nominal, *deviation.worst, *deviation.slopes.values()):
            assert repr(number) in told or number == 0.0, (deviation.name, number)
    assert found.variants and found.lost == 0 and found.to_pandas().shape[0] == len(found)


def test_reactions_are_those_of_the_command():
    path = ROOT / "examples/compressor.mech"
    found = mechc.load(path).reactions()
    table = command("run", str(path), "--reactions").table()
    assert len(found.columns) > 5 and all(same_bits(found[name], table[name]) for name in found)
    assert not [name for name in found if name.endswith(".x")]


def test_reactions_have_their_derivatives():
    path = ROOT / "examples/compressor.mech"
    m = mechc.load(path)
    param = next(iter(m.params))
    plain, found, whole = m.reactions(), m.reactions(by=param), m.run(reactions=True, by=param)
    assert found.columns == [*plain.columns, *(f"{name}.by.{param}" for name in plain.columns if name != "t")]
    table = command("run", str(path), "--reactions", "--by", param).table()
    assert all(same_bits(found[name], table[name]) and same_bits(found[name], whole[name]) for name in found)
    assert np.abs(found[f"{plain.columns[-1]}.by.{param}"]).max() > 0.0


def test_answers_stay_as_they_are():
    m = mechc.load(CRANK)
    found = m.tolerance({"rod_length": "0.05 mm"}, results=PEAK)
    for again in (found, pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        for held in (again.ranges, again.deviations, again["peak"].slopes, again["peak"].contributions, again["peak"].shares):
            kept = dict(held)
            changes = [held.clear, held.popitem, lambda: held.update(a=1), lambda: held.pop("peak", None), lambda: held.setdefault("a", 1)]
            changes += [lambda: held.__setitem__("a", 1), lambda: held.__delitem__(next(iter(held))), lambda: held.__ior__({"a": 1})]
            for change in changes:
                with pytest.raises(TypeError, match="cannot be changed"):
                    change()
            assert held == kept
        assert json.loads(json.dumps(again["peak"].slopes)) == found["peak"].slopes and again == found
        assert dataclasses.asdict(again["peak"])["slopes"] == found["peak"].slopes
    j = m.jacobian(by=["rod_length", "speed"], results=PEAK)
    f = m.residuals(["travel"], [0.0, 0.1], by=["rod_length"], at=[0.0, 0.01])
    g = m.objective("peak", by=["rod_length"], results=PEAK)
    for held in (lambda: j.by, lambda: j.result_names, lambda: f.by, lambda: f.columns, lambda: g.by):
        kept = held()
        held().append("nothing")
        assert held() == kept and "nothing" not in kept
    assert j["travel"].shape == (81, 2) and f.jacobian(f.x0).shape == (2, 1)


def test_tolerances_are_taken_by_name_and_are_no_array():
    found = mechc.load(CRANK).tolerance({"rod_length": "0.05 mm"}, results=PEAK)
    assert dict(found) == dict(found.items()) == dict(zip(found.keys(), found.values())) == found.deviations
    # the names alone, which iterating gives, would be a table of names
    pandas = pytest.importorskip("pandas")
    for take in (np.asarray, pandas.DataFrame):
        with pytest.raises(TypeError, match="`to_pandas\\(\\)`"):
            take(found)
    assert found.to_pandas()["name"].tolist() == list(found)


def test_a_jacobian_is_called_by_name():
    j = mechc.load(CRANK).jacobian(by=["rod_length"], every="20 ms")
    for name in (3, ["travel"], None):
        with pytest.raises(KeyError, match="there are no derivatives of"):
            j[name]
    with pytest.raises(TypeError, match="not iterable"):
        list(j)


def test_a_path_that_names_nothing_is_refused(tmp_path, monkeypatch):
    m = mechc.load(CRANK)
    monkeypatch.chdir(tmp_path)
    for write in (m.to_latex, m.to_json, m.to_rust, m.view):
        for empty in ("", b""):
            with pytest.raises(mechc.UsageError, match="`path` is empty"):
                write(empty)
    assert not list(tmp_path.iterdir())


def test_nothing_is_written_over_what_was_read(tmp_path):
    own = tmp_path / "own.mech"
    own.write_text(CRANK.read_text())
    m = mechc.load(own)
    for write in (m.to_latex, m.to_json):
        with pytest.raises(mechc.FileError, match="read from it"):
            write(own)
    assert own.read_text() == CRANK.read_text()
    assert m.to_latex(tmp_path / "own.tex").exists()


STOPPED = """mechanism stopped {
    ground { point O = (0, 0) point Q = (80 mm, 0) }
    body crank at (0, 0, 90 deg) { point O = (0, 0) point C = (40 mm, 0) }
    body coupler at (0, 40 mm, 36 deg) { point C = (0, 0) point D = (LENGTH, 0) }
    body rocker at (80 mm, 0, 91 deg) { point Q = (0, 0) point D = (50 mm, 0) }
    joint main: revolute(ground.O, crank.O)
    joint pin: revolute(crank.C, coupler.C)
    joint knee: revolute(coupler.D, rocker.D)
    joint pivot: revolute(ground.Q, rocker.Q)
    driver motor: rotation(main) = 90 deg + 60 rpm * t
    measure turn = angle(rocker) / 1 deg
    analysis from 0 s to 2 s every 10 ms
}
"""


@pytest.mark.parametrize("length, kind, code", [("60 mm", mechc.LockUp, "E0602"), ("400 mm", mechc.NotAssembled, "E0601")])
def test_a_page_tells_why_it_ends_as_the_command_does(tmp_path, length, kind, code):
    source = tmp_path / "stopped.mech"
    source.write_text(STOPPED.replace("LENGTH", length))
    m = mechc.load(source)
    ended = command("view", str(source), "-o", str(tmp_path / "wanted.html"))
    for name in ("a.html", "a.svg"):
        with pytest.raises(kind) as caught:
            m.view(tmp_path / name)
        assert ended.code == 3 and str(caught.value).splitlines()[0] == ended.err.splitlines()[0]
        assert caught.value.code == code and caught.value.partial == tmp_path / name and caught.value.partial.exists()
        with pytest.warns(mechc.MechcWarning, match=code) as told:
            assert m.view(tmp_path / name, strict=False).exists()
        assert told[0].filename == __file__ and told[0].message.diagnostics[0]["code"] == code
    assert (tmp_path / "a.html").read_text() == (tmp_path / "wanted.html").read_text()
    text = m._repr_html_()
    assert "<pre>error[" + code in text and str(caught.value).splitlines()[0] in html.unescape(text)


def test_a_page_of_a_whole_motion_tells_nothing():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert "<pre>" not in mechc.load(CRANK)._repr_html_()
