"""Values as the library reads them: numbers are SI and get their unit, texts have theirs."""

from __future__ import annotations

import difflib
import math
import numbers
import operator
import os
import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Union

import numpy as np

from mechc.errors import AnalysisError, UsageError

#: Arrays have at most so many dimensions, as numpy's interface for other languages has.
MOST_DIMENSIONS = 32

#: A number in SI, or a text with its unit: ``0.18`` or ``"180 mm"``.
Value = Union[float, int, str, "np.floating[Any]", "np.integer[Any]"]


def usage(message: str, help: str | None = None, kind: type[UsageError] = UsageError) -> UsageError:
    """Wrong usage, as the command says it."""
    return kind(*said("E0706", message, help))


def refused(message: str, help: str) -> AnalysisError:
    """A number that cannot be had."""
    return AnalysisError(*said("N0604", message, help))


def said(
    code: str, message: str, help: str | None = None, data: dict[str, Any] | None = None
) -> tuple[str, list[dict[str, Any]]]:
    """A message as the library has one: its text, and itself as data."""
    diagnostic = {
        "code": code,
        "severity": "error",
        "message": message,
        "labels": [],
        "notes": [],
        "help": [] if help is None else [help],
        "fixes": [],
        "data": data or {},
    }
    text = f"error[{code}]: {message}"
    if help is not None:
        text += f"\n = help: {help}"
    return text, [diagnostic]


def number(name: str, value: Any) -> float:
    """A finite number; ``name`` is what it is for."""
    if isinstance(value, (bool, np.bool_)) or isinstance(value, (str, bytes)):
        raise usage(f"`{name}` is {value!r}, which is no number")
    if isinstance(value, np.ndarray) and value.ndim > 0:
        raise usage(f"`{name}` is an array of shape {value.shape}, and one number is wanted")
    _refuse_masked(name, value)
    if np.iscomplexobj(value):
        raise usage(f"`{name}` is {_shown(value)}, and a real number is wanted")
    try:
        found = float(value)
    except (TypeError, ValueError, OverflowError):
        raise usage(f"`{name}` is {_shown(value)}, which is no number", "give a number in SI, or a text with a unit") from None
    if not math.isfinite(found):
        raise usage(f"`{name}` is {found}", "only finite numbers can be computed with")
    return found


def _refuse_masked(name: str, values: Any) -> None:
    """What is masked is no number, whatever stands below the mask."""
    if isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values):
        raise usage(f"`{name}` has elements that are masked", "only numbers can be computed with")


def whole(name: str, value: Any, least: int = 0) -> int:
    """A whole number from ``least`` on."""
    if isinstance(value, (bool, np.bool_)):
        raise usage(f"`{name}` is {value!r}, and a whole number is wanted")
    try:
        found = operator.index(value)
    except TypeError:
        is_whole = isinstance(value, numbers.Real) and math.isfinite(value) and float(value).is_integer()
        if not is_whole:
            raise usage(f"`{name}` is {_shown(value)}, and a whole number is wanted") from None
        found = int(value)
    if not least <= found < 2**63:
        raise usage(f"`{name}` is {found}, and a whole number from {least} on is wanted")
    return found


def written(name: str, value: Any, unit: str) -> str:
    """A value as a formula; a number gets the unit."""
    if isinstance(value, str):
        if not value.strip():
            raise usage(f"`{name}` is an empty text", "give a number in SI, or a text with a unit")
        return value
    text = repr(number(name, value))
    return f"{text}{unit}" if unit.startswith("/") else f"{text} {unit}".rstrip()


#: What mappings are like, by the options that take them.
_EXAMPLES = {
    "set": "{'leg[1].la': '180 mm'}",
    "inputs": "{'theta': '20 deg'}",
    "rates": "{'theta': '5 rad/s'}",
    "accelerations": "{'theta': '2 rad/s^2'}",
    "files": "{'leg.mech': text}",
    "vary": "{'rod_length': [0.1, 0.2]}",
    "tol": "{'rod_length': '0.05 mm'}",
}


def mapping(option: str, given: Any) -> dict[str, Any]:
    """A mapping from names, whatever kind of one it is."""
    if not isinstance(given, Mapping):
        raise usage(f"`{option}` is {_shown(given)}, and a mapping is wanted", f"as in `{option}={_EXAMPLES[option]}`")
    found = dict(given)
    for name in found:
        if not isinstance(name, str):
            raise usage(f"`{option}` has {_shown(name)}, which is no name", f"as in `{option}={_EXAMPLES[option]}`")
    return found


def path_of(name: str, value: Any, help: str | None = None) -> str:
    """A path: a text, bytes, or whatever stands for one."""
    try:
        return os.fsdecode(os.fspath(value))
    except TypeError:
        raise usage(f"`{name}` is {_shown(value)}, and a path is wanted", help) from None


def many(name: str, values: Any) -> list[Any]:
    """Some values: a list, an array, or a single one."""
    if isinstance(values, str) or not isinstance(values, Iterable):
        return [values]
    if isinstance(values, np.ndarray):
        if values.ndim > 1:
            raise usage(f"`{name}` is an array of shape {values.shape}, and one of one dimension is wanted")
        return values.reshape(-1).tolist()
    if isinstance(values, Mapping):
        raise usage(f"`{name}` is {_shown(values)}, and a list is wanted")
    return list(values)


def texts(name: str, values: Any) -> list[str]:
    """Some texts, or one."""
    if values is None:
        return []
    found = many(name, values)
    for text in found:
        if not isinstance(text, str):
            raise usage(f"`{name}` has {_shown(text)}, and texts are wanted")
    return found


def plain(name: str) -> str:
    """A name as the language compares it: without spaces, letters with marks as one character (NFC)."""
    return unicodedata.normalize("NFC", "".join(name.split()))


def first_twice(names: Iterable[str]) -> str | None:
    """The first name that stands twice."""
    seen: set[str] = set()
    for name in names:
        if name in seen:
            return name
        seen.add(name)
    return None


def meant(name: str, known: Iterable[str]) -> str | None:
    """The name that may be meant, as a question."""
    near = difflib.get_close_matches(name, list(known), n=1)
    return f"was `{near[0]}` meant?" if near else None


def _shown(value: Any) -> str:
    try:
        text = repr(value)
    except Exception:  # what cannot even be shown
        text = f"an object of {type(value).__name__}"
    return text if len(text) <= 60 else text[:57] + "…"


@dataclass(frozen=True)
class Between:
    """A range of a param, made by :func:`between`."""

    first: Value
    last: Value
    count: int | None = None


def between(first: Value, last: Value, count: int | None = None) -> Between:
    """A range of a param that is to vary, for :meth:`mechc.Mechanism.sweep`.

    With ``count`` so many values, evenly, both ends included; without it the range is one that ``samples`` are drawn from.
    Numbers are SI, texts have units: ``between("100 mm", "200 mm", 50)``.
    """
    return Between(first, last, None if count is None else whole("count", count, 1))


def varied(name: str, values: Any, unit: str) -> str | bytes:
    """What varies, as the command's ``--vary`` has it; numbers in a list as a table, which is read faster."""
    if isinstance(values, Between):
        ends = f"{written(name, values.first, unit)}..{written(name, values.last, unit)}"
        return f"{name}={ends}" if values.count is None else f"{name}={ends}:{values.count}"
    if isinstance(values, str):
        return f"{name}={values}"
    found = values if isinstance(values, np.ndarray) and values.ndim > 0 else many(name, values)
    if len(found) == 0:
        raise usage(f"`{name}` varies over no value", "give a list of values, or `mechc.between(A, B, N)`")
    if not isinstance(found, np.ndarray) and any(isinstance(value, str) for value in found):
        return f"{name}=" + ",".join(written(name, value, unit) for value in found)
    return table({name: found}, {name: unit})


def table(columns: Mapping[str, Any], units: Mapping[str, str]) -> bytes:
    """Variants as the CSV that the command reads: a column for each param, numbers in SI."""
    lists: dict[str, list[float]] = {}
    for name, values in columns.items():
        _refuse_masked(name, values)
        array = np.asarray(values)
        if array.ndim != 1 or array.dtype.kind not in "iuf":
            listed = many(name, values)
            array = np.array([number(name, value) for value in listed])
        if array.size and not np.isfinite(array.astype(float)).all():
            raise usage(f"`{name}` varies over what is not finite", "only finite numbers can be computed with")
        lists[name] = array.astype(float).tolist()
    lengths = {len(values) for values in lists.values()}
    if len(lengths) != 1 or lengths == {0}:
        told = ", ".join(f"`{name}` has {len(values)}" for name, values in lists.items())
        raise usage(f"the columns of variants are not of one length: {told}" if lists else "there are no variants")
    head = ",".join(f"{name} [{_head(units[name])}]" if units.get(name) else name for name in lists)
    rows = "\n".join(",".join(map(repr, row)) for row in zip(*lists.values()))
    return f"{head}\n{rows}\n".encode()


def _head(unit: str) -> str:
    """A unit as the head of a column has it: ``/s^2`` is ``s^-2`` there."""
    if not unit.startswith("/"):
        return unit
    parts = (part.partition("^") for part in unit[1:].split("/"))
    return "*".join(f"{name}^-{power or 1}" for name, _, power in parts)


def elements(name: str, values: Any) -> float | np.ndarray[Any, Any]:
    """Numbers for many elements, as an array; a number for what is one."""
    if isinstance(values, (bool, np.bool_)):
        return number(name, values)
    _refuse_masked(name, values)
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        raise usage(f"`{name}` is {_shown(values)}, which is no array of numbers") from None
    if array.ndim == 0:
        return number(name, values if array.dtype == object else array[()])
    if array.dtype.kind not in "iuf":
        raise usage(f"`{name}` is an array of {array.dtype}, and one of numbers is wanted", "numbers are taken in SI")
    if array.ndim > MOST_DIMENSIONS:
        raise usage(f"`{name}` is an array of {array.ndim} dimensions", f"it may have at most {MOST_DIMENSIONS}")
    array = np.ascontiguousarray(array, dtype=np.float64)
    if not np.isfinite(array).all():
        raise usage(f"`{name}` has elements that are not finite", "only finite numbers can be computed with")
    return array


def alike(arrays: list[np.ndarray[Any, Any]]) -> list[np.ndarray[Any, Any]]:
    """Arrays of one shape."""
    if all(array.shape == arrays[0].shape for array in arrays):
        return arrays
    try:
        return [np.ascontiguousarray(array) for array in np.broadcast_arrays(*arrays)]
    except ValueError:
        shapes = ", ".join(str(array.shape) for array in arrays)
        raise usage(f"arrays of the shapes {shapes} do not go together", "numpy's rules of broadcasting hold") from None
