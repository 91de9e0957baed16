"""Options, params and inputs by keywords: one rule for all of them, and mechc's words for whatever is handed over instead."""

from __future__ import annotations

import collections
import contextlib
import inspect
import pathlib
import types
import warnings

import numpy as np
import pytest
from conftest import OTHER_SIDE, ROOT

import mechc
from mechc import _mechc

CRANK = ROOT / "examples/slider_crank.mech"
TEXT = CRANK.read_text()
PEAK = {"peak": "max(abs(der(der(travel))))"}
AS_TEXT = "peak = max(abs(der(der(travel))))"

#: Questions, with what they cannot do without.
QUESTIONS = {
    "run": {"columns": "t"},
    "sweep": {"vary": {"crank_length": [0.05]}, "results": PEAK},
    "reactions": {},
    "jacobian": {"by": ["crank_length"], "every": "20 ms"},
    "objective": {"result": "peak", "by": ["crank_length"], "results": PEAK},
    "residuals": {"columns": ["travel"], "wanted": [0.0], "by": ["crank_length"], "at": [0.0]},
    "tolerance": {"tol": {"crank_length": 1e-5}, "every": "20 ms"},
    "at": {"t": 0.0},
}

#: Values of options that may stand beside these.
GIVEN = {
    "strict": True, "failed": 1.0, "normal": False, "verify": False, "seed": 3, "skip": 0, "take": 1, "jobs": 1, "columns": "t",
    "lead": False, "rows": False, "progress": False, "yes": False, "method": "sobol", "until": "t > 0", "variants": "none.csv",
    "samples": 3, "by": ["crank_length"], "reactions": False, "tolerance": 1e-9, "every": "20 ms", "from_": 0.0, "to": 0.04,
    "results": AS_TEXT, "at": 0.0, "pass_bifurcations": False, "allow_redundant": False,
    **dict.fromkeys(("set", "inputs", "rates", "accelerations"), 0.1),
}


def options_of(name):
    kind = inspect.Parameter
    like = "run" if name == "reactions" else name
    found = inspect.signature(getattr(_mechc.Mechanism if name == "at" else mechc.Mechanism, like)).parameters
    return [of for of, how in found.items() if how.kind is not kind.VAR_KEYWORD and of not in ("self", "t")]


CASES = [(question, option) for question in QUESTIONS for option in options_of(question)]


def asked(m, question, given):
    """What is said of names while a question is put."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        try:
            getattr(m, question)(**given)
        except (mechc.UsageError, mechc.FileError):
            # names are looked at first
            pass
    return [str(one.message) for one in told if "is taken for the option" in str(one.message)]


@pytest.mark.parametrize("question, option", CASES, ids=[f"{question}-{option}" for question, option in CASES])
def test_every_option_of_every_question_says_that_its_name_wins(question, option):
    try:
        m = mechc.parse(TEXT.replace("rod_length", option))
    except mechc.InputError:
        pytest.skip("a word of the language is no name of a param")
    value = QUESTIONS[question][option] if option in QUESTIONS[question] else GIVEN[option]
    told = asked(m, question, {**QUESTIONS[question], option: value})
    # a mapping is no value of a param
    assert len(told) == (0 if isinstance(value, dict) else 1)
    assert all(f"set={{'{option}': …}}" in words and f"vary={{'{option}': …}}" in words for words in told)
    if option not in QUESTIONS[question]:
        assert not asked(m, question, {**QUESTIONS[question], "set": {option: "150 mm"}})


def test_who_gives_no_such_option_is_told_nothing():
    m = mechc.parse(TEXT.replace("rod_length", "strict"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert m.run(set={"strict": 0.18}).rows == m.reactions().rows == 81
        assert len(m.sweep(vary={"strict": [0.15, 0.18]}, results=PEAK).read()["strict"]) == 2
        m.at(0.0, set={"strict": 0.18})


def test_inputs_too():
    text = "mechanism m { input columns = 1 rad * sin(1 rad/s * t) ground { point O = (0, 0) } body b { point O = (0, 0) }\n" \
        "joint j: revolute(ground.O, b.O) driver d: rotation(j) = columns analysis from 0 s to 1 s every 0.5 s }"
    m = mechc.parse(text)
    with pytest.warns(mechc.MechcWarning, match=r"an input `columns` too, which is told by `inputs=\{'columns': …\}`"):
        m.run(columns="t")


def test_a_param_may_be_called_like_what_python_hands_over():
    m = mechc.parse(TEXT.replace("rod_length", "self"))
    assert m.run(self=0.18).rows == 81 and m.sweep({"crank_length": [0.05]}, results=PEAK, self=0.15).read().rows == 1


def test_whoever_warns_points_at_the_line_that_asked():
    m = mechc.parse(TEXT.replace("rod_length", "every"))
    side = mechc.parse(OTHER_SIDE)
    asks = [
        lambda: m.run(every="10 ms"),
        lambda: m.reactions(every="10 ms"),
        lambda: m.jacobian(["crank_length"], every="10 ms"),
        lambda: m.at(0.0, by=["crank_length"], set={"every": 0.18}) and mechc.parse(TEXT.replace("rod_length", "by")).at(0.0, by="t"),
        lambda: side.run(lead=True, turned=5.2),
        lambda: mechc.parse(OTHER_SIDE, set={"turned": 5.2}).run(),
    ]
    for ask in asks:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            with contextlib.suppress(mechc.UsageError, mechc.InputError):
                ask()
        assert told and all(one.filename == __file__ for one in told), [(one.filename, str(one.message)) for one in told]


class Own(collections.UserDict):
    """A mapping that is no dict."""


class Place:
    """A path that is no text."""

    def __init__(self, path):
        self.path = path

    def __fspath__(self):
        return str(self.path)


def test_any_mapping_and_any_path():
    assert mechc.load(Place(CRANK), set=Own(rod_length="180 mm")).params["rod_length"] == 0.18
    m = mechc.load(Place(CRANK))
    kinds = (Own, types.MappingProxyType, collections.OrderedDict, dict)
    robot = mechc.load(ROOT / "examples/parallel_robot.mech")
    found = {robot.at(inputs=kind({"swing[0]": 0.1}), rates=kind({"swing[0]": 1.0})).q.tobytes() for kind in kinds}
    assert len(found) == 1
    runs = [m.run(set=kind({"rod_length": 0.15}), results=kind(PEAK)).results["peak"] for kind in kinds]
    runs += [m.sweep(kind({"rod_length": [0.15]}), results=PEAK).read()["peak"][0] for kind in kinds]
    runs += [m.tolerance(kind({"rod_length": 1e-5}), results=PEAK)["peak"].nominal for kind in kinds]
    assert len(set(runs)) == 1
    files = Own({pathlib.PurePosixPath("legs/jansen_leg.mech"): bytearray((ROOT / "examples/jansen_leg.mech").read_bytes())})
    text = 'use "legs/jansen_leg.mech"\nmechanism one { input turn = 1 rad part leg: jansen_leg(turn = turn) at (0, 0, 0) }'
    assert mechc.parse(text, files=files, name=pathlib.Path("one.mech"), mechanism="one").inputs


@pytest.mark.parametrize(
    "ask, words",
    [
        (lambda m: mechc.parse(TEXT, files="x"), "`files` is an object of str, and a mapping from paths is wanted"),
        (lambda m: mechc.parse(TEXT, files={3: "x"}), "`files` is 3, and a path is wanted"),
        (lambda m: mechc.parse(TEXT, files={"a": 3}), "the file 'a' is an object of int"),
        (lambda m: mechc.parse(TEXT, name=3), "`name` is 3, and a path is wanted"),
        (lambda m: mechc.parse(TEXT, mechanism=3), "3 is no name of a mechanism"),
        (lambda m: mechc.parse(TEXT, set=0.1), "`set` is 0.1, and a mapping is wanted"),
        (lambda m: mechc.parse(TEXT, set=0), "`set` is 0, and a mapping is wanted"),
        (lambda m: mechc.parse(TEXT, allow_redundant="yes"), "`allow_redundant` is 'yes', and `True` or `False` is wanted"),
        (lambda m: mechc.load(3), "`path` is 3, and a path is wanted"),
        (lambda m: m.run(set=0.1), "`set` is 0.1, and a mapping is wanted"),
        (lambda m: m.run(set={3: 0.1}), "`set` has 3, which is no name"),
        (lambda m: m.run(inputs=[1]), r"`inputs` is \[1\], and a mapping is wanted"),
        (lambda m: m.run(strict="no"), "`strict` is 'no', and `True` or `False` is wanted"),
        (lambda m: m.at(0.0, set=0.1), "`set` is 0.1, and a mapping is wanted"),
        (lambda m: m.at(0.0, inputs="x"), "`inputs` is 'x', and a mapping is wanted"),
        (lambda m: m.at(0.0, rates=3), "`rates` is 3, and a mapping is wanted"),
        (lambda m: m.at(0.0, reactions="x"), "`reactions` is 'x', and `True` or `False` is wanted"),
        (lambda m: m.at(0.0, strict=0), "`strict` is 0, and `True` or `False` is wanted"),
        (lambda m: m.at(0.0, tolerance="x"), "`tolerance` is 'x', which is no number"),
        (lambda m: m.at(0.0, tolerance=-1.0), "`tolerance` is -1.0"),
        (lambda m: m.at(0.0, by=[3]), "`by` has 3, and texts are wanted"),
        (lambda m: m.at(0.0).stacked([3]), "`names` has 3, and texts are wanted"),
        (lambda m: m.sweep([1]), r"`vary` is \[1\], and a mapping is wanted"),
        (lambda m: m.tolerance(0.1), "`tol` is 0.1, and a mapping is wanted"),
        (lambda m: m.tolerance({"rod_length": 1e-5}, verify=3), "`verify` is 3, and `True` or `False` is wanted"),
        (lambda m: m.objective("peak", ["rod_length"], results=PEAK, failed="x"), "`failed` is 'x', which is no number"),
        (lambda m: m.objective("peak", ["rod_length"], results=PEAK)("x"), r"`x` is .*'x'.*, which is no number"),
        (lambda m: m.objective("peak", ["rod_length"], results=PEAK)([0.1, 0.2]), "2 values are given for 1 params"),
        (lambda m: m.residuals(["travel"], "x", ["rod_length"], at=[0.0]), r"`wanted` is .*'x'.*, which is no number"),
        (lambda m: m.to_latex(3), "`path` is 3, and a path is wanted"),
        (lambda m: m.to_rust(sensitivities=1), "`sensitivities` is 1, and `True` or `False` is wanted"),
        (lambda m: m.view(3), "`path` is 3, and a path is wanted"),
    ],
)
def test_what_is_something_else_is_told_in_words(ask, words):
    with pytest.raises(mechc.UsageError, match=words):
        ask(mechc.load(CRANK))


def test_infinity_may_stand_for_what_failed():
    f = mechc.load(CRANK).objective("peak", by=["rod_length"], results=PEAK, failed=np.inf)
    assert f([0.01])[0] == np.inf


@pytest.mark.parametrize("given", [{"at": []}, {"at": np.array([])}, {"columns": []}, {"columns": ()}])
def test_a_choice_of_nothing_is_not_all(given):
    m = mechc.load(CRANK)
    with pytest.raises(mechc.UsageError, match="leave it out for all"):
        m.run(**given)
    with pytest.raises(mechc.UsageError, match="leave it out for all"):
        m.sweep(vary={"crank_length": [0.05]}, rows=True, **given)


@pytest.mark.parametrize("value", [1 + 1j, np.complex128(0.05), np.array(0.05 + 0j), np.ma.masked_array(0.05, mask=True)])
def test_what_is_not_real_or_is_masked_is_no_number(value):
    m = mechc.load(CRANK)
    with pytest.raises(mechc.UsageError):
        m.at(0.0, crank_length=value)
    with pytest.raises(mechc.UsageError):
        m.run(crank_length=value)


def test_masked_elements_are_no_numbers():
    m, masked = mechc.load(CRANK), np.ma.masked_array([0.05, 0.06], mask=[False, True])
    for ask in (lambda: m.at(0.0, crank_length=masked), lambda: m.sweep(vary={"crank_length": masked}, results=PEAK)):
        with pytest.raises(mechc.UsageError, match="masked"):
            ask()
    whole = np.ma.masked_array([0.05, 0.06], mask=False)
    assert len(m.sweep(vary={"crank_length": whole}, results=PEAK)) == 2


@pytest.mark.parametrize("name", ["variant", "status", "stopped"])
def test_results_do_not_take_the_names_of_a_sweeps_own_columns(name):
    with pytest.raises(mechc.UsageError, match="two columns of the table would be called"):
        mechc.load(CRANK).sweep(vary={"crank_length": [0.05]}, results={name: "max(travel)"})


def test_variants_may_be_any_frame():
    import polars as pl
    import pyarrow as pa

    m, lengths = mechc.load(CRANK), {"crank_length": [0.05, 0.055]}
    wanted = m.sweep(variants=lengths, results=PEAK).read()["peak"]
    table = pa.table(lengths)
    for frame in (table, table.to_batches()[0], pl.DataFrame(lengths), pl.LazyFrame(lengths)):
        assert np.array_equal(m.sweep(variants=frame, results=PEAK).read()["peak"], wanted), type(frame)


def test_what_derivatives_give_is_not_changed_from_outside():
    m = mechc.load(CRANK)
    j = m.jacobian(by=["crank_length"], results=PEAK, every="20 ms")
    f = m.objective("peak", by=["crank_length"], results=PEAK)
    for array in (j.results, f.x0):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 1.0
    f.by.append("rod_length")
    assert np.isfinite(f.value(f.x0))
    with pytest.raises(mechc.UsageError, match="twice"):
        m.jacobian(by=["crank_length", "crank_length"])


def test_a_mechanism_does_not_change():
    m = mechc.load(CRANK)
    with pytest.raises(AttributeError, match="m.run\\(rod_length=…\\)"):
        m.rod_length = 0.3
    with pytest.raises(AttributeError):
        m.anything = 1
    with pytest.raises(mechc.UsageError, match="given twice"):
        m.run(rod_length=0.2, set={"rod_length": 0.21})
    with pytest.raises(mechc.UsageError, match="vary={'rod_length'"):
        m.sweep(rod_length=[0.1, 0.2])


def test_times_of_residuals_have_units():
    m = mechc.load(CRANK)
    f = m.residuals(["travel"], [0.0, 0.0], by="rod_length", at=["1 ms", "2 ms"])
    g = m.residuals(["travel"], [0.0, 0.0], by="rod_length", at=[1e-3, 2e-3])
    assert f(f.x0).tolist() == g(g.x0).tolist()
    with pytest.raises(mechc.UsageError, match="do not rise"):
        m.residuals(["travel"], [0.0, 0.0], by="rod_length", at=["10 ms", "5 ms"])
    with pytest.raises(mechc.UsageError, match=r"shape \(3,\) are given for 2 columns"):
        m.residuals(["travel", "t"], [0.0, 0.0, 0.0], by="rod_length", at=[0.001])


def test_times_that_go_with_params_have_no_residuals():
    text = (ROOT / "examples/hoeken.mech").read_text().replace("to 2 s every 20 ms", "to 2 * pi / speed every 0.25 * pi / speed")
    m, wanted = mechc.parse(text), np.zeros((9, 1))
    f = m.residuals(["pen_x"], wanted, by=["speed"])
    for ask in (f, f.jacobian):
        with pytest.raises(mechc.UsageError, match="times of the analysis go with the params"):
            ask(f.x0)
    for by, at in (["speed"], np.linspace(0, 1, 9)), (["base"], None):
        f = m.residuals(["pen_x"], wanted, by=by, at=at)
        difference = (f(f.x0 + 1e-6) - f(f.x0 - 1e-6)) / 2e-6
        assert np.allclose(f.jacobian(f.x0)[:, 0], difference, atol=1e-6)


def test_files_that_are_not_handed_over_are_told():
    text = 'use "parts/leg.mech" mechanism m { ground { point O = (0, 0) } }'
    with pytest.raises(mechc.MechcError, match="`files` has `part/leg.mech` alone"):
        mechc.parse(text, files={"part/leg.mech": "mechanism leg { }"})
    with pytest.raises(mechc.MechcError, match="`files` has none"):
        mechc.parse(text)
