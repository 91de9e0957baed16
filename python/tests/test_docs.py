"""The guide's examples run as they stand there, one after the other, in the project's top folder."""

from __future__ import annotations

import doctest
import os
import re

import pytest
from conftest import ROOT

BLOCK = re.compile(r"^```(python|pycon)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def sections():
    """The guide by its headings; what one has, the ones behind it know."""
    text = (ROOT / "docs/python.md").read_text()
    return re.split(r"^(?=## )", text, flags=re.MULTILINE)[1:]


@pytest.mark.timeout(600)
@pytest.mark.filterwarnings("ignore")
def test_the_guide(monkeypatch):
    pytest.importorskip("jax")
    monkeypatch.chdir(ROOT)
    before = set(os.listdir(ROOT))
    names: dict[str, object] = {}
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE | doctest.IGNORE_EXCEPTION_DETAIL)
    parser, found = doctest.DocTestParser(), {"python": 0, "pycon": 0}
    for section in sections():
        title = section.splitlines()[0]
        for kind, code in BLOCK.findall(section):
            found[kind] += 1
            if kind == "python":
                exec(compile(code, title, "exec"), names)
                continue
            test = parser.get_doctest(code, names, title, "docs/python.md", 0)
            told: list[str] = []
            runner.run(test, out=told.append, clear_globs=False)
            names.update(test.globs)
            assert not told, "\n".join(told)
    assert found["python"] >= 10 and found["pycon"] >= 8
    assert set(os.listdir(ROOT)) == before


def test_the_readmes_example(monkeypatch):
    monkeypatch.chdir(ROOT)
    found = [code for kind, code in BLOCK.findall((ROOT / "README.md").read_text()) if kind == "python"]
    assert len(found) == 1
    exec(compile(found[0], "README.md", "exec"), {})
