"""What is asked of a mechanism, from keywords to the options of the command."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from typing import Any

from mechc.errors import MechcWarning
from mechc.values import many, meant, number, table, texts, usage, whole, written
from mechc.values import varied as one_varied

#: What every question may hold.
COMMON = (
    "set",
    "inputs",
    "samples",
    "lead",
    "results",
    "by",
    "slopes",
    "reactions",
    "from_",
    "to",
    "every",
    "at",
    "columns",
    "tolerance",
    "pass_bifurcations",
    "allow_redundant",
)


def asked(
    units_of_params: Mapping[str, str],
    units_of_inputs: Mapping[str, str],
    options: Iterable[str],
    values: Mapping[str, Any],
    *,
    set: Mapping[str, Any] | None = None,
    inputs: Mapping[str, Any] | None = None,
    samples: Any = None,
    lead: bool = False,
    results: Any = None,
    by: Any = None,
    slopes: bool = False,
    reactions: bool = False,
    from_: Any = None,
    to: Any = None,
    every: Any = None,
    at: Any = None,
    columns: Any = None,
    tolerance: Any = None,
    pass_bifurcations: bool = False,
    allow_redundant: bool = False,
) -> dict[str, Any]:
    """The options of the command, by their names; ``values`` are the keywords that are none of ``options``."""
    warn_of_options(units_of_params, units_of_inputs, locals(), options)
    params, signals = split(values, units_of_params, units_of_inputs, options)
    return {
        "set": settings(set, params, units_of_params),
        "inputs": settings(inputs, signals, units_of_inputs),
        "samples": None if samples is None else _path("samples", samples),
        "lead": _flag("lead", lead),
        "results": formulas(results),
        "by": texts("by", by),
        "slopes": slopes,
        "reactions": _flag("reactions", reactions),
        "from": _time("from_", from_),
        "to": _time("to", to),
        "every": _time("every", every),
        "at": [] if at is None else [time for time in (_time("at", one) for one in many("at", at)) if time is not None],
        "columns": texts("columns", columns),
        "tolerance": None if tolerance is None else _tolerance(tolerance),
        "pass_bifurcations": _flag("pass_bifurcations", pass_bifurcations),
        "allow_redundant": _flag("allow_redundant", allow_redundant),
    }


def warn_of_options(
    params: Mapping[str, str], inputs: Mapping[str, str], given: Mapping[str, Any], options: Iterable[str]
) -> None:
    """Says of options that are given that their names win over those of params and inputs."""
    for name in options:
        if (name in params or name in inputs) and given.get(name) not in (None, False):
            where = f"set={{'{name}': …}}" if name in params else f"inputs={{'{name}': …}}"
            message = (
                f"`{name}` is taken for the option of that name; the mechanism has {'a param' if name in params else 'an input'} "
                f"`{name}` too, which is meant by `{where}`"
            )
            warnings.warn(MechcWarning(message), stacklevel=5)


def split(
    values: Mapping[str, Any], params: Mapping[str, str], inputs: Mapping[str, str], options: Iterable[str]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Keywords that are params, and those that are inputs."""
    of_params, of_inputs = {}, {}
    for name, value in values.items():
        if name in params:
            of_params[name] = value
        elif name in inputs:
            of_inputs[name] = value
        else:
            known = [*params, *inputs, *options]
            raise usage(f"there is no param, input or option `{name}`", meant(name, known) or _listed(params, inputs))
    return of_params, of_inputs


def _listed(params: Mapping[str, str], inputs: Mapping[str, str]) -> str:
    parts = [("params", list(params)), ("inputs", list(inputs))]
    told = [f"the {what} are " + ", ".join(f"`{name}`" for name in names[:8]) for what, names in parts if names]
    return "; ".join(told) if told else "the mechanism has neither params nor inputs"


def settings(given: Mapping[str, Any] | None, values: Mapping[str, Any], units: Mapping[str, str]) -> list[str]:
    """``NAME=FORMULA`` for each; a number has the unit of what it sets."""
    if given is not None and not isinstance(given, Mapping):
        raise usage("`set` and `inputs` are mappings from names to values", "as in `set={'leg[1].la': '180 mm'}`")
    found = {}
    for name, value in {**(given or {}), **values}.items():
        if not isinstance(name, str):
            raise usage(f"{name!r} is no name")
        plain = "".join(name.split())
        found[plain] = f"{plain}={written(name, value, unit_of(plain, units))}"
    return list(found.values())


def unit_of(name: str, units: Mapping[str, str]) -> str:
    """The SI unit of a param or input; of all copies where the name has no number."""
    if name in units:
        return units[name]
    for known, unit in units.items():
        owner, dot, rest = known.partition(".")
        if f"{owner.partition('[')[0]}{dot}{rest}" == name or known.partition("[")[0] == name:
            return unit
    return ""


def formulas(results: Any) -> list[str]:
    """Results as ``NAME = FORMULA``: a mapping, a list of such texts, or one."""
    if isinstance(results, Mapping):
        return [f"{name} = {formula}" for name, formula in results.items()]
    return texts("results", results)


def _time(name: str, value: Any) -> str | None:
    if value is None:
        return None
    return value if isinstance(value, str) else repr(number(name, value))


def _tolerance(value: Any) -> float:
    found = number("tolerance", value)
    if not 0.0 < found < 1.0:
        raise usage(f"`tolerance` is {found!r}", "a number above 0 and below 1 is wanted, as in `tolerance=1e-9`")
    return found


def _flag(name: str, value: Any) -> bool:
    if value is True or value is False:
        return value
    raise usage(f"`{name}` is {value!r}, and `True` or `False` is wanted")


def _path(name: str, value: Any) -> str:
    try:
        path = os.fspath(value)
    except TypeError:
        raise usage(f"`{name}` is {value!r}, and a path is wanted") from None
    return os.fsdecode(path)


def varied(
    units: Mapping[str, str],
    vary: Any,
    variants: Any,
    *,
    samples: Any,
    method: Any,
    seed: Any,
    rows: bool,
    until: Any,
    jobs: Any,
    skip: Any,
    take: Any,
    asked: Mapping[str, Any],
) -> dict[str, Any]:
    """What of a sweep goes beyond a run, by the names of the command's options."""
    found: list[str] = []
    lists: list[bytes] = []
    for name, values in _axes(vary):
        told = one_varied(name, values, unit_of(name, units))
        (lists if isinstance(told, bytes) else found).append(told)  # type: ignore[arg-type]
    if isinstance(variants, (str, os.PathLike)):
        found.append(f"@{_path('variants', variants)}")
    elif variants is not None:
        columns = _columns_of(variants)
        lists.append(table(columns, {name: unit_of(name, units) for name in columns}))
    if not found and not lists:
        raise usage("it is not said what varies", "as in `vary={'rod_length': mechc.between('100 mm', '200 mm', 50)}`")
    if method not in (None, "sobol", "random"):
        raise usage(f"`method` is {method!r}", "it is `'sobol'` or `'random'`")
    if until is not None and not isinstance(until, str):
        raise usage(f"`until` is {until!r}, and a condition is wanted", "as in `until='stroke > 80 mm'`")
    if _flag("rows", rows) is False:
        if asked["at"]:
            help = "add `rows=True` for the rows at these times, or measure with `results={'NAME': 'at(…, T)'}`"
            raise usage("results are of the whole analysis, and `at` asks for single times", help)
        if asked["columns"]:
            raise usage("`columns` chooses columns of rows", "add `rows=True`")
    return {
        "vary": found,
        "lists": lists,
        "samples": None if samples is None else whole("samples", samples),
        "method": method,
        "seed": None if seed is None else whole("seed", seed),
        "rows": rows,
        "until": until,
        "jobs": None if jobs is None else min(whole("jobs", jobs, 1), MOST_JOBS),
        "skip": whole("skip", skip),
        "take": None if take is None else whole("take", take),
    }


#: More threads only wait for each other.
MOST_JOBS = 1024


def _axes(vary: Any) -> Iterable[tuple[str, Any]]:
    if vary is None:
        return []
    if not isinstance(vary, Mapping):
        raise usage("`vary` is a mapping from params to what they are", "as in `vary={'rod_length': [0.1, 0.2]}`")
    for name in vary:
        if not isinstance(name, str) or not name.strip():
            raise usage(f"{name!r} is no name of a param")
    return [("".join(name.split()), values) for name, values in vary.items()]


def _columns_of(variants: Any) -> dict[str, Any]:
    """A table of variants: a mapping to arrays, or a frame."""
    if isinstance(variants, Mapping):
        columns = dict(variants)
    elif hasattr(variants, "columns") and hasattr(variants, "__getitem__"):
        columns = {name: variants[name] for name in variants.columns}
    else:
        raise usage(f"`variants` is an object of {type(variants).__name__}", "a mapping from params to arrays, a frame or a path is wanted")
    for name in columns:
        if not isinstance(name, str):
            raise usage(f"{name!r} is no name of a param")
    return {name: getattr(column, "to_numpy", lambda column=column: column)() for name, column in columns.items()}


def off(name: str, ends: Any, unit: str) -> str:
    """How far a param may be off, as the command's ``--tol`` has it."""
    if isinstance(ends, (tuple, list)):
        if len(ends) != 2:
            raise usage(f"the tolerance of `{name}` is {ends!r}", "one value is plus and minus, two are from and to")
        return f"{name}={written(name, ends[0], unit)}..{written(name, ends[1], unit)}"
    return f"{name}={written(name, ends, unit)}"
