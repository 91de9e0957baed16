"""Messages speak of options as Python has them."""

from __future__ import annotations

import json
import re

import pytest
from conftest import ROOT

import mechc
from mechc._mechc import _in_python

CRANK = ROOT / "examples/slider_crank.mech"

#: What only the command has.
OF_THE_COMMAND = {"with"}


def spans():
    """All that the library's messages say of options, but for the command's own files, and the pages of the language."""
    folders = [folder for folder in (ROOT / "crates").iterdir() if folder.name != "ide"]
    for path in (path for folder in folders for path in folder.rglob("src/**/*.rs") if "vocabulary" not in path.parts):
        code = "\n".join(line for line in path.read_text().partition("#[cfg(test)]")[0].splitlines() if not line.lstrip().startswith("//"))
        yield from (found[1] for found in re.finditer(r"`(--[a-z][^`\n]*)`", code))


def test_every_option_that_messages_speak_of_has_words_here():
    found = sorted(set(spans()))
    assert len(found) > 25
    for span in found:
        options = set(re.findall(r"--([a-z-]+)", span))
        message = _in_python(f"write `{span}` there")
        assert "--" not in message or options <= OF_THE_COMMAND, message


@pytest.mark.parametrize(
    "command, python",
    [
        ("`--lead`", "`lead=True`"),
        ("`--pass-bifurcations`", "`pass_bifurcations=True`"),
        ("`--set reach=60mm`", "`set={'reach': '60mm'}`"),
        ("`--set 'A=(12mm,0)'`", "`set={'A': '(12mm,0)'}`"),
        ("leave `--set` out", "leave `set={…}` out"),
        ("`--vary rod=100mm..200mm:50`", "`vary={'rod': mechc.between('100mm', '200mm', 50)}`"),
        ("`--vary speed=60rpm,90rpm`", "`vary={'speed': ['60rpm', '90rpm']}`"),
        ("`--vary @variants.csv`", "`variants='variants.csv'`"),
        ("`--sample 1000`", "`samples=1000`"),
        ("`--tol rod=-0.1mm..0mm`", "`tol={'rod': ('-0.1mm', '0mm')}`"),
        ("`--result 'stroke = max(x(P)) - min(x(P))'`", "`results={'stroke': 'max(x(P)) - min(x(P))'}`"),
        ("`--from T --to T --every H`, or `--at T`", "`from_=T, to=T, every=H`, or `at=T`"),
        ("`--skip K --take N`", "`skip=K, take=N`"),
        ("`--mechanism NAME`", "`mechanism='NAME'`"),
        ("--set is no place", "--set is no place"),
        ("a -- b", "a -- b"),
    ],
)
def test_words(command, python):
    assert _in_python(command) == python


def test_messages_and_their_data_have_them():
    m = mechc.load(CRANK)
    asks = [
        (lambda: m.sweep({"rod_length": mechc.between(0.1, 0.2)}), "samples=1000"),
        (lambda: m.run(columns="zz.*"), "columns='rod.*'"),
        (lambda: mechc.parse(m.text.partition("    analysis")[0] + "}").run(), "every=H"),
        (lambda: m.run(set={"rod_length": "(1 m"}), "set rod_length:1"),
    ]
    for ask, wanted in asks:
        with pytest.raises(mechc.MechcError) as caught:
            ask()
        assert wanted in str(caught.value) and "--" not in str(caught.value), str(caught.value)
        assert "--" not in json.dumps(caught.value.diagnostics)


@pytest.mark.parametrize("deep", ["-" * 300 + "1 m", "-" * 3000 + "1 m", "(" * 3000 + "1 m" + ")" * 3000])
def test_what_is_too_deep_is_said_of_the_keyword(deep):
    """Of lines that are too long to be shown the place stands alone."""
    m, robot = mechc.load(CRANK), mechc.load(ROOT / "examples/parallel_robot.mech")
    asks = [
        (lambda: m.run(set={"rod_length": deep}), "set rod_length:1:"),
        (lambda: m.run(rod_length=deep), "set rod_length:1:"),
        (lambda: mechc.load(CRANK, set={"rod_length": deep}), "set rod_length:1:"),
        (lambda: m.run(results={"p": deep}), "results:1:"),
        (lambda: m.run(from_=deep), "from_:1:"),
        (lambda: m.run(at=[deep]), "at:1:"),
        (lambda: robot.run(inputs={"swing[0]": deep}), "inputs swing[0]:1:"),
        (lambda: m.sweep({"rod_length": [deep]}), "vary rod_length:1:"),
        (lambda: m.sweep({"rod_length": [0.14]}, until=f"{deep} > 1 m"), "until:1:"),
        (lambda: m.tolerance({"rod_length": deep}), "tol rod_length:1:"),
    ]
    for ask, place in asks:
        with pytest.raises(mechc.UsageError, match="E0103") as caught:
            ask()
        for text in (str(caught.value), json.dumps(caught.value.diagnostics)):
            assert not re.search(r"--[a-z]", text), text
        lead = "" if len(deep) > 1000 else "  ┌─ "
        assert f"\n{lead}{place}" in f"\n{caught.value}"
