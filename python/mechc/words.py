"""What messages of the library say of the command's options, in Python's words: ``--lead`` is ``lead=True``."""

from __future__ import annotations

import re
from typing import Any

#: Options that are given or not.
FLAGS = {name: name.replace("-", "_") for name in "lead reactions pass-bifurcations allow-redundant rows yes verify normal".split()}

#: Options with a value.
VALUES = {
    **{name: name for name in "to every at columns samples method seed until mechanism skip take jobs lanes tolerance".split()},
    "from": "from_",
    "sample": "samples",
}

#: Options of the form ``NAME=FORMULA``.
MAPPINGS = {"set": "set", "input": "inputs", "result": "results", "tol": "tol", "vary": "vary"}

#: What only files of the command have, and what is done instead.
WHOLE = {
    "leave it out with `--with equations`, in a file that `-o` names": "write the equations alone with the command: `mechc emit --with equations`",
    "`A..B:50`": "`mechc.between(A, B, 50)`",
}

_SPAN = re.compile(r"`(--[a-z][^`\n]*)`")
_OPTION = re.compile(r"--([a-z][a-z-]*)(?:[ =]+((?:'[^']*'|(?!--)\S+|\s+(?!--))+))?")
#: Where a message says what it is of: above the text that it shows, or, where that is too long to be shown, before a line and a column.
_SOURCE = re.compile(r"^(\s*┌─ |\s*(?=--[^:]*:\d+:\d+: ))--([a-z-]+)")
_LINE_OF_TEXT = re.compile(r"\s*\d+ │")
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?")
_RANGE = re.compile(r"(.+?)\.\.(.+?)(?::(\S+))?")


def in_python(text: str) -> str:
    """A message that may speak of options; lines that it shows of a text stay as they are."""
    if "--" not in text and "`A..B" not in text:
        return text
    lines = [line if _LINE_OF_TEXT.match(line) else _worded(line) for line in text.split("\n")]
    return "\n".join(lines)


def told(value: Any, name: str = "") -> Any:
    """The same of a diagnostic as data."""
    if isinstance(value, dict):
        # what edits put into a text is none of the words
        is_edit = {"file", "start", "end", "text"} == value.keys()
        as_it_is = ("data", "code", "text") if is_edit else ("data", "code")
        return {key: of if key in as_it_is else told(of, key) for key, of in value.items()}
    if isinstance(value, list):
        return [told(one, name) for one in value]
    if not isinstance(value, str):
        return value
    return re.sub(r"^--([a-z-]+)", lambda found: _called(found[1]), value) if name == "file" else in_python(value)


def _worded(line: str) -> str:
    for words, instead in WHOLE.items():
        line = line.replace(words, instead)
    line = _SOURCE.sub(lambda found: found[1] + _called(found[2]), line)
    return _SPAN.sub(lambda found: f"`{_spoken(found[1])}`", line)


def _called(option: str) -> str:
    """What an option is called here."""
    return FLAGS.get(option) or VALUES.get(option) or MAPPINGS.get(option) or option.replace("-", "_")


def _spoken(options: str) -> str:
    """Options with their values as keywords."""
    return ", ".join(_keyword(found[1], (found[2] or "").strip()) for found in _OPTION.finditer(options))


def _keyword(option: str, value: str) -> str:
    name, value = _called(option), value[1:-1] if value[:1] == value[-1:] == "'" else value
    if option in FLAGS:
        return f"{name}=True"
    if option == "vary" and value.startswith("@"):
        return f"variants={value[1:]!r}"
    if option not in MAPPINGS:
        return f"{name}={_literal(value)}" if value else name
    of, is_said, formula = (part.strip() for part in value.partition("="))
    if not is_said:
        return f"{name}={{{_literal(value)}}}"
    formula = formula[1:-1] if formula[:1] == formula[-1:] == "'" else formula
    return f"{name}={{{of!r}: {_values(option, formula)}}}"


def _values(option: str, formula: str) -> str:
    """What a param is set to, or varies over, or may be off."""
    is_range = _RANGE.fullmatch(formula) if option in ("vary", "tol") else None
    if is_range and option == "tol":
        return f"({_literal(is_range[1])}, {_literal(is_range[2])})"
    if is_range:
        return f"mechc.between({', '.join(_literal(part) for part in is_range.groups() if part)})"
    if option == "vary" and "," in formula:
        return f"[{', '.join(_literal(part) for part in formula.split(','))}]"
    return _literal(formula)


def _literal(value: str) -> str:
    """A value as Python has it: numbers, and letters that stand for any, as they are; the rest as texts."""
    is_plain = not value or value == "…" or _NUMBER.fullmatch(value) or re.fullmatch("[A-Z]", value)
    return (value or "…") if is_plain else repr(value)
