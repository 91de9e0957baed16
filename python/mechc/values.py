"""Values as the library reads them: numbers are SI and get their unit, texts have theirs."""

from __future__ import annotations

import difflib
import itertools
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
    """Returns the error for wrong usage."""
    return kind(*diagnostic_of("E0706", message, help))


def missing_value(message: str, help: str) -> AnalysisError:
    """Returns the error for a result or derivative without a value."""
    return AnalysisError(*diagnostic_of("N0604", message, help))


def diagnostic_of(
    code: str, message: str, help: str | None = None, data: dict[str, Any] | None = None
) -> tuple[str, list[dict[str, Any]]]:
    """Returns an error message as printed text, and as diagnostics."""
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


def checked_text(name: str, text: str) -> str:
    """Returns a text; one with a lone surrogate is refused, as it cannot be encoded."""
    if not text.isascii():
        try:
            text.encode()
        except UnicodeEncodeError as error:
            message = f"`{name}` has {ascii(text[error.start])} at character {error.start + 1}, which is half a character"
            raise usage(message, "give text that was decoded whole") from None
    return text


def number(name: str, value: Any) -> float:
    """Returns a finite number; ``name`` is that of the argument in messages."""
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
    """Refuses arrays with masked elements."""
    if isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values):
        raise usage(f"`{name}` has elements that are masked", "only numbers can be computed with")


def whole_number(name: str, value: Any, least: int = 0) -> int:
    """Returns a whole number that is at least ``least``."""
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


def formula_of(name: str, value: Any, unit: str) -> str:
    """Returns a value as a formula; a number gets the unit."""
    if isinstance(value, str):
        if not value.strip():
            raise usage(f"`{name}` is an empty text", "give a number in SI, or a text with a unit")
        return checked_text(name, value)
    if isinstance(value, (Between, list, tuple)):
        help = f"what varies is said to a sweep: `m.sweep(vary={{'{name}': …}})`"
        raise usage(f"`{name}` is {_shown(value)}, and one value is wanted", help)
    text = repr(number(name, value))
    return f"{text}{unit}" if unit.startswith("/") else f"{text} {unit}".rstrip()


#: Examples of mappings, by the options that take them.
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
    """Returns a mapping from names as a dictionary."""
    if not isinstance(given, Mapping):
        raise usage(f"`{option}` is {_shown(given)}, and a mapping is wanted", f"as in `{option}={_EXAMPLES[option]}`")
    found = dict(given)
    for name, value in found.items():
        if not isinstance(name, str):
            raise usage(f"`{option}` has {_shown(name)}, which is no name", f"as in `{option}={_EXAMPLES[option]}`")
        checked_text(option, name)
        if isinstance(value, str):
            checked_text(name, value)
    return found


def path_of(name: str, value: Any, help: str | None = None) -> str:
    """Returns a path as a text."""
    try:
        path = os.fsdecode(os.fspath(value))
    except TypeError:
        raise usage(f"`{name}` is {_shown(value)}, and a path is wanted", help) from None
    try:
        # bytes that are no text are a name for the system; half a character is none
        os.fsencode(path)
    except UnicodeEncodeError:
        raise usage(f"`{name}` is {_shown(path)}, which has half a character, and no file is called so") from None
    if "\0" in path:
        raise usage(f"`{name}` is {_shown(path)}, which has a NUL in it, and no file is called so")
    return path


def as_list(name: str, values: Any) -> list[Any]:
    """Returns a list, an array of one dimension, or a single value as a list."""
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
    """Returns a list of texts, or a single text, as a list."""
    if values is None:
        return []
    found = as_list(name, values)
    for text in found:
        if not isinstance(text, str):
            raise usage(f"`{name}` has {_shown(text)}, and texts are wanted")
        checked_text(name, text)
    return found


def normalized(name: str) -> str:
    """Returns a name as the language compares it: without spaces, in Unicode normal form C."""
    return unicodedata.normalize("NFC", "".join(name.split()))


def first_duplicate(names: Iterable[str]) -> str | None:
    """Returns the first name that occurs twice."""
    seen: set[str] = set()
    for name in names:
        if name in seen:
            return name
        seen.add(name)
    return None


def suggestion(name: str, known: Iterable[str]) -> str | None:
    """Returns the most similar known name as a question."""
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
    return Between(first, last, None if count is None else whole_number("count", count, 1))


def vary_option(name: str, values: Any, unit: str) -> str | bytes:
    """Returns an axis of variation as the command's ``--vary`` takes it; a list of numbers as a CSV table, which is read faster."""
    if isinstance(values, Between):
        ends = f"{formula_of(name, values.first, unit)}..{formula_of(name, values.last, unit)}"
        return f"{name}={ends}" if values.count is None else f"{name}={ends}:{values.count}"
    if isinstance(values, str):
        return f"{name}={checked_text(name, values)}"
    _refuse_masked(name, values)
    # arrays of texts are taken as lists of them are
    are_numbers = isinstance(values, np.ndarray) and values.ndim > 0 and values.dtype.kind not in "OUT"
    found = values if are_numbers else as_list(name, values)
    if len(found) == 0:
        raise usage(f"`{name}` varies over no value", "give a list of values, or `mechc.between(A, B, N)`")
    if not isinstance(found, np.ndarray) and any(isinstance(value, str) for value in found):
        return f"{name}=" + ",".join(formula_of(name, value, unit) for value in found)
    return table({name: found}, {name: unit})


def table(columns: Mapping[str, Any], units: Mapping[str, str]) -> bytes:
    """Returns variants as CSV: a column for each param, numbers in SI."""
    lists: dict[str, list[float]] = {}
    for name, values in columns.items():
        checked_text("variants", name)
        _refuse_masked(name, values)
        array = np.asarray(values)
        if array.ndim != 1 or array.dtype.kind not in "iuf":
            listed = as_list(name, values)
            array = np.array([number(name, value) for value in listed])
        if array.size and not np.isfinite(array.astype(float)).all():
            raise usage(f"`{name}` varies over what is not finite", "only finite numbers can be computed with")
        lists[name] = array.astype(float).tolist()
    lengths = {len(values) for values in lists.values()}
    if len(lengths) != 1 or lengths == {0}:
        listed = ", ".join(f"`{name}` has {len(values)}" for name, values in lists.items())
        is_uneven = len(lengths) > 1
        raise usage(f"the columns of variants are not of one length: {listed}" if is_uneven else "there are no variants")
    head = ",".join(_quoted(f"{name} [{_head(units[name])}]" if units.get(name) else name) for name in lists)
    rows = "\n".join(",".join(map(repr, row)) for row in zip(*lists.values()))
    return f"{head}\n{rows}\n".encode()


def _quoted(head: str) -> str:
    """The head of a column as a CSV has it: names of copies of copies have commas (RFC 4180)."""
    return '"' + head.replace('"', '""') + '"' if any(mark in head for mark in ',"\ufeff') else head


def _head(unit: str) -> str:
    """A unit as the head of a column has it: ``/s^2`` is ``s^-2`` there."""
    if not unit.startswith("/"):
        return unit
    parts = (part.partition("^") for part in unit[1:].split("/"))
    return "*".join(f"{name}^-{power or 1}" for name, _, power in parts)


def text_array(values: Any) -> tuple[list[str], list[int]] | None:
    """Returns the texts of a list or an array, flat, and its shape; ``None`` for anything else."""
    is_array = isinstance(values, np.ndarray)
    if not (is_array and values.dtype.kind in "UTO" or isinstance(values, (list, tuple)) and _begins_with_text(values)):
        return None
    try:
        array = np.array(values, dtype=object)
    except ValueError:
        return None
    flat = array.reshape(-1).tolist()
    if array.ndim == 0 or not flat or not all(isinstance(text, str) for text in flat):
        return None
    return flat, list(array.shape)


def _begins_with_text(values: Any) -> bool:
    while isinstance(values, (list, tuple)) and values:
        values = values[0]
    return isinstance(values, (str, np.ndarray))


def elements(name: str, values: Any) -> float | np.ndarray[Any, Any]:
    """Returns an array of finite numbers; a single value as a number."""
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
    # what is spread out by numpy has its elements once, and is not spread out before it is known how many there are to be
    once = tuple(slice(1) if stride == 0 else slice(None) for stride in array.strides)
    held = np.ascontiguousarray(array[once], dtype=np.float64)
    if not np.isfinite(held).all():
        raise usage(f"`{name}` has elements that are not finite", "only finite numbers can be computed with")
    return held if held.shape == array.shape else np.broadcast_to(held, array.shape)


def broadcast(arrays: list[np.ndarray[Any, Any]]) -> list[np.ndarray[Any, Any]]:
    """Broadcasts arrays to one shape; refuses more elements than fit into memory."""
    # it takes its messages from here
    from mechc import memory

    shape = _common([array.shape for array in arrays])
    memory.refuse_elements(math.prod(shape))
    try:
        return [np.ascontiguousarray(np.broadcast_to(array, shape)) for array in arrays]
    except MemoryError:
        raise memory.too_many(math.prod(shape)) from None


def _common(shapes: list[tuple[int, ...]]) -> tuple[int, ...]:
    """Returns the shape to which arrays are broadcast by numpy's rules; it may have more elements than numpy allows."""
    found = []
    for sizes in itertools.zip_longest(*(shape[::-1] for shape in shapes), fillvalue=1):
        own = {size for size in sizes if size != 1}
        if len(own) > 1:
            listed = ", ".join(str(shape) for shape in shapes)
            raise usage(f"arrays of the shapes {listed} do not go together", "numpy's rules of broadcasting hold")
        found.append(own.pop() if own else 1)
    return tuple(found[::-1])
