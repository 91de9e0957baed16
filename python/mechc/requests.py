"""Converts keyword arguments of methods to the options of the command."""

from __future__ import annotations

import functools
import inspect
import itertools
import os
import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar, Union

from mechc._mechc import LARGEST_FILE
from mechc.errors import MechcWarning, warn
from mechc.values import as_list, checked_text, formula_of, mapping, normalized, number, path_of, suggestion, table, texts, usage
from mechc.values import vary_option, whole_number

Method = TypeVar("Method", bound=Callable[..., Any])


def with_options(method: Method, *, like: Iterable[Callable[..., Any]] = ()) -> Method:
    """Decorates a method whose keywords are its options and those of the methods ``like``, and else params and inputs. An option that is
    given, and has the name of a param or an input, is a warning; an unknown keyword is refused."""
    parameters = [of for one in (method, *like) for of in list(inspect.signature(one).parameters.values())[1:]]
    options = {of.name: None for of in parameters if of.kind is not of.VAR_KEYWORD}

    @functools.wraps(method)
    def wrapper(m: Any, /, *arguments: Any, **keywords: Any) -> Any:
        params, inputs = m._param_units, m._input_units
        keywords = {name if name in options else _keyword(name, [*params, *inputs]): value for name, value in keywords.items()}
        warn_of_options(params, inputs, {name: value for name, value in keywords.items() if name in options})
        refuse_unknown([name for name in keywords if name not in options], params, inputs, options)
        return method(m, *arguments, **keywords)

    return wrapper  # type: ignore[return-value]


def run_request(
    units_of_params: Mapping[str, str],
    units_of_inputs: Mapping[str, str],
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
    """Returns the options of a run by their names; ``values`` are the keywords that are params and inputs."""
    params = {name: value for name, value in values.items() if name in units_of_params}
    signals = {name: value for name, value in values.items() if name not in units_of_params}
    return {
        "set": settings("set", set, params, units_of_params),
        "inputs": settings("inputs", inputs, signals, units_of_inputs),
        "samples": None if samples is None else path_of("samples", samples),
        "lead": flag("lead", lead),
        "results": formulas(results),
        "by": texts("by", by),
        "slopes": slopes,
        "reactions": flag("reactions", reactions),
        "from": _time("from_", from_),
        "to": _time("to", to),
        "every": _time("every", every),
        "at": _times(at),
        "columns": _patterns(columns),
        "tolerance": None if tolerance is None else bound(tolerance),
        "pass_bifurcations": flag("pass_bifurcations", pass_bifurcations),
        "allow_redundant": flag("allow_redundant", allow_redundant),
    }


def warn_of_options(params: Mapping[str, str], inputs: Mapping[str, str], given: Mapping[str, Any]) -> None:
    """Warns of given options whose names hide params or inputs, and says how to set these. A mapping can only be meant as the option, and
    `None` is not given."""
    for name in (name for name, value in given.items() if value is not None and not isinstance(value, Mapping)):
        if name in params:
            instead = f"a param `{name}` too, which is set by `set={{'{name}': …}}`, and varied by `vary={{'{name}': …}}`"
        elif name in inputs:
            instead = f"an input `{name}` too, which is told by `inputs={{'{name}': …}}`"
        else:
            continue
        warn(MechcWarning(f"`{name}` is taken for the option of that name; the mechanism has {instead}"))


def _keyword(name: str, known: list[str]) -> str:
    """Returns the known name of a keyword, in which Python replaces some letters (NFKC), as ``µ``."""
    found = normalized(name)
    alike = [] if found in known else [of for of in known if unicodedata.normalize("NFKC", of) == found]
    return alike[0] if len(alike) == 1 else found


def resolve_name(
    name: str, option: str, params: Mapping[str, str], inputs: Mapping[str, str], options: Iterable[str]
) -> list[str]:
    """Returns the params or inputs that a name refers to; ``option`` is ``set`` or ``inputs``, or empty for a keyword."""
    kinds = {"set": [params], "inputs": [inputs]}.get(option, [params, inputs])
    for kind in kinds:
        found = names_of(name if option else _keyword(name, list(kind)), kind)
        if found:
            return found
    if option == "set" and names_of(name, inputs):
        raise usage(f"`{name}` is an input, and `set` sets params", f"tell it by `inputs={{'{name}': …}}`")
    if option == "inputs" and names_of(name, params):
        raise usage(f"`{name}` is a param, and `inputs` tells inputs", f"set it by `set={{'{name}': …}}`")
    refuse_unknown([name], params, inputs, options)
    return []


def names_of(name: str, known: Iterable[str]) -> list[str]:
    """Returns the known names that a name refers to: itself, all copies if it has no numbers, or the coordinates of a point."""
    found, known = normalized(name), list(known)
    if found in known:
        return [found]
    copies = [of for of in known if re.sub(r"\[[^\]]*\]", "", of) == found]
    point = [f"{found}.x", f"{found}.y"]
    return copies or (point if all(axis in known for axis in point) else [])


def refuse_unknown(
    names: Iterable[str], params: Mapping[str, str], inputs: Mapping[str, str], options: Iterable[str]
) -> None:
    """Refuses keywords that are neither params nor inputs."""
    for name in names:
        if name not in params and name not in inputs:
            checked_text("a name", name)
            known = [*params, *inputs, *options]
            raise usage(f"there is no param, input or option `{name}`", suggestion(name, known) or _listed(params, inputs))


def _listed(params: Mapping[str, str], inputs: Mapping[str, str]) -> str:
    parts = [("params", list(params)), ("inputs", list(inputs))]
    listed = [f"the {what} are " + ", ".join(f"`{name}`" for name in names[:8]) for what, names in parts if names]
    return "; ".join(listed) if listed else "the mechanism has neither params nor inputs"


def settings(option: str, given: Any, values: Mapping[str, Any], units: Mapping[str, str]) -> list[str]:
    """Returns ``NAME=FORMULA`` for each value; a number has the unit of its param or input."""
    found = {}
    for name, value in itertools.chain(({} if given is None else mapping(option, given)).items(), values.items()):
        known = normalized(name)
        if known in found:
            raise usage(f"`{known}` is given twice", "say it once")
        found[known] = f"{known}={formula_of(name, value, unit_of(known, units))}"
    return list(found.values())


def unit_of(name: str, units: Mapping[str, str]) -> str:
    """Returns the SI unit of the params or inputs that a name refers to."""
    return next((units[known] for known in names_of(name, units)), "")


def formulas(results: Any) -> list[str]:
    """Returns results as ``NAME = FORMULA``, from a mapping, a list of such texts, or one text."""
    if isinstance(results, Mapping):
        return [checked_text("results", f"{name} = {formula}") for name, formula in results.items()]
    return texts("results", results)


def _time(name: str, value: Any) -> str | None:
    if value is None:
        return None
    return checked_text(name, value) if isinstance(value, str) else repr(number(name, value))


def _times(at: Any) -> list[str]:
    """Returns the times of ``at``; an empty list is refused as a likely mistake."""
    found = [] if at is None else [time for time in (_time("at", one) for one in as_list("at", at)) if time is not None]
    if at is not None and not found:
        raise usage("`at` holds no time", "leave it out for all times of the analysis")
    return found


def _patterns(columns: Any) -> list[str]:
    """Returns patterns of columns; an empty list is refused as a likely mistake."""
    found = texts("columns", columns)
    if columns is not None and not found:
        raise usage("`columns` chooses no column", "leave it out for all columns")
    return found


def bound(value: Any) -> float:
    """Returns the tolerance of the equations, between 0 and 1."""
    found = number("tolerance", value)
    if not 0.0 < found < 1.0:
        raise usage(f"`tolerance` is {found!r}", "a number above 0 and below 1 is wanted, as in `tolerance=1e-9`")
    return found


def flag(name: str, value: Any) -> bool:
    """Returns an option that is true or false."""
    if value is True or value is False:
        return value
    raise usage(f"`{name}` is {value!r}, and `True` or `False` is wanted")


def sweep_request(
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
    request: Mapping[str, Any],
) -> dict[str, Any]:
    """Returns the options of a sweep in addition to those of a run, by the names of the command's options."""
    found: list[Axis] = []
    for name, values in _axes(vary):
        axis = vary_option(name, values, unit_of(name, units))
        found.append((f"vary {name}", axis) if isinstance(axis, bytes) else axis)
    if isinstance(variants, (str, os.PathLike)):
        found.append(_variants_of(checked_text("variants", path_of("variants", variants))))
    elif variants is not None:
        columns = _columns_of(variants)
        found.append(("variants", table(columns, {name: unit_of(name, units) for name in columns})))
    if not found:
        raise usage("it is not said what varies", "as in `vary={'rod_length': mechc.between('100 mm', '200 mm', 50)}`")
    if method not in (None, "sobol", "random"):
        raise usage(f"`method` is {method!r}", "it is `'sobol'` or `'random'`")
    if until is not None and not isinstance(until, str):
        raise usage(f"`until` is {until!r}, and a condition is wanted", "as in `until='stroke > 80 mm'`")
    if until is not None:
        checked_text("until", until)
    if flag("rows", rows) is False:
        if request["at"]:
            help = "add `rows=True` for the rows at these times, or measure with `results={'NAME': 'at(…, T)'}`"
            raise usage("results are of the whole analysis, and `at` asks for single times", help)
        if request["columns"]:
            raise usage("`columns` chooses columns of rows", "add `rows=True`")
        for option in ("by", "reactions"):
            if request[option]:
                raise usage(f"`{option}` adds columns to rows", "add `rows=True`")
    return {
        "vary": found,
        "samples": None if samples is None else whole_number("samples", samples),
        "method": method,
        "seed": None if seed is None else whole_number("seed", seed),
        "rows": rows,
        "until": until,
        "jobs": None if jobs is None else min(whole_number("jobs", jobs, 1), MOST_JOBS),
        "skip": whole_number("skip", skip),
        "take": None if take is None else whole_number("take", take),
    }


#: Largest number of threads; more of them only wait for each other.
MOST_JOBS = 1024

#: An axis of variation: the text of the command's option, or a table as CSV with its name in messages.
Axis = Union[str, "tuple[str, bytes]"]


def _variants_of(path: str) -> Axis:
    """Reads a table of variants at once, so that a sweep never changes; for an unreadable file the command reports the error."""
    try:
        if os.path.isfile(path) and os.path.getsize(path) <= LARGEST_FILE:
            with open(path, "rb") as file:
                return path, file.read()
    except OSError:
        pass
    return f"@{path}"


def _axes(vary: Any) -> Iterable[tuple[str, Any]]:
    given = {} if vary is None else mapping("vary", vary)
    if any(not name.strip() for name in given):
        raise usage("`vary` has an empty name, and that of a param is wanted")
    return [(normalized(name), values) for name, values in given.items()]


def _columns_of(variants: Any) -> dict[str, Any]:
    """Returns the columns of a table of variants, from a mapping to arrays or a frame."""
    if hasattr(variants, "collect_schema") and hasattr(variants, "collect"):
        # a lazy frame
        variants = variants.collect()
    if isinstance(variants, Mapping):
        columns = dict(variants)
    elif hasattr(variants, "schema") and hasattr(variants, "column"):
        columns = {name: variants.column(name) for name in variants.schema.names}
    elif hasattr(variants, "columns") and hasattr(variants, "__getitem__"):
        columns = {name: variants[name] for name in variants.columns}
    else:
        raise usage(f"`variants` is an object of {type(variants).__name__}", "a mapping from params to arrays, a frame or a path is wanted")
    for name in columns:
        if not isinstance(name, str):
            raise usage(f"{name!r} is no name of a param")
    return {name: getattr(column, "to_numpy", lambda column=column: column)() for name, column in columns.items()}


def tolerance_option(name: str, ends: Any, unit: str) -> str:
    """Returns the tolerance of a param as the command's ``--tol`` takes it."""
    if isinstance(ends, (tuple, list)):
        if len(ends) != 2:
            raise usage(f"the tolerance of `{name}` is {ends!r}", "one value is plus and minus, two are from and to")
        return f"{name}={formula_of(name, ends[0], unit)}..{formula_of(name, ends[1], unit)}"
    return f"{name}={formula_of(name, ends, unit)}"
