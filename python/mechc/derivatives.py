"""Exact derivatives of results and measures by params: as matrices, and as what optimisers call."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mechc.requests import names_of
from mechc.errors import AnalysisError, UsageError
from mechc.tables import Run
from mechc.values import elements, first_duplicate, missing_value, normalized, suggestion, texts, usage

if TYPE_CHECKING:
    from mechc.mechanism import Mechanism

Array = NDArray[np.float64]


class Jacobian:
    """The derivatives of results and columns by params, exact to rounding; made by :meth:`mechc.Mechanism.jacobian`.

    ``j.results`` has a row for each result and a column for each param, of shape (results, params), in SI; ``j["travel"]`` the
    derivatives of a column along the motion, of shape (rows, params), in the column's unit by SI. ``j.run`` is the motion itself.
    """

    def __init__(self, run: Run, names: list[str], by: list[str], results: Array) -> None:
        #: The motion, with the columns ``NAME.by.PARAM``.
        self.run = run
        self._by = by
        self._names = names
        results.setflags(write=False)
        #: Of shape (results, params), in SI.
        self.results = results

    @property
    def by(self) -> list[str]:
        """The params and inputs that it is by."""
        return list(self._by)

    @property
    def result_names(self) -> list[str]:
        """The names of the rows of ``results``."""
        return list(self._names)

    # it is no sequence, for all that it has items
    __iter__ = None

    def __getitem__(self, name: str) -> Array:
        """The derivatives of a column, or of a result."""
        if name in self._names:
            return self.results[self._names.index(name)]
        columns = [f"{name}.by.{by}" for by in self._by]
        if name not in self.run or any(column not in self.run for column in columns):
            known = [*self._names, *(known for known in self.run if not self.run._derived(known)[1] and known not in (name, "t"))]
            hint = suggestion(name, known) if isinstance(name, str) else None
            raise KeyError(f"there are no derivatives of {name!r}" + (f"; {hint}" if hint else ""))
        return np.column_stack([self.run[column] for column in columns])

    @property
    def t(self) -> Array:
        """The times of the rows (s)."""
        return self.run.t

    def __repr__(self) -> str:
        return f"<Jacobian: {len(self._names)} results and {self.run.rows} rows by {', '.join(self._by)}>"


def jacobian(m: Mechanism, by: Any, request: dict[str, Any]) -> Jacobian:
    """Computes the derivatives of results and columns."""
    request = {**request, "by": _names(by), "slopes": True}
    run = m._execute(request, True)
    everything = run._results
    by_all = _variables(run)
    own = len(everything) // (len(by_all) + 1)
    values = [np.nan if value is None else value for _, value, _ in everything]
    results = np.array(values[own:]).reshape(own, len(by_all)) if own else np.empty((0, len(by_all)))
    names = [name for name, _, _ in everything[:own]]
    run._results = everything[:own]
    return Jacobian(run, names, by_all, results)


def _names(by: Any) -> list[str]:
    evaluated = [normalized(name) for name in texts("by", by)]
    if not evaluated:
        raise usage("it is not said what it is by", "as in `by=['rod_length']`")
    twice = first_duplicate(evaluated)
    if twice is not None:
        raise usage(f"`by` names `{twice}` twice", "each derivative is there once")
    return evaluated


def _variables(run: Run) -> list[str]:
    """Returns the variables of the derivatives in the order of the columns; a name in ``by`` without a number refers to all copies."""
    behind = [by for _, by in map(run._derived, run) if by]
    return list(dict.fromkeys(behind))


class Objective:
    """A result, or what is made of columns, as a function of params, with its exact gradient.

    ``f(x)`` gives value and gradient, for ``scipy.optimize.minimize(f, x0, jac=True)``; ``f.value(x)`` and ``f.gradient(x)`` one of
    them. ``x`` are the params in the order of ``f.by`` (SI). Where the mechanism does not get there, or the result has no value, an
    error is raised, or with ``failed=math.inf`` that is the value, and the gradient is zero. Where it has a value and no derivative,
    as an extremum at a jump that goes with a param, the gradient is an error; ``f.value(x)`` is for methods without gradients. It can be
    pickled: the mechanism goes along, and is compiled anew where it arrives.
    """

    def __init__(self, evaluate: Evaluation, place: int, failed: float | None) -> None:
        self._evaluate = evaluate
        self._place = place
        self._name = evaluate.results[place]
        self._failed = failed
        #: The values of the params in the text, with what was set (SI).
        self.x0 = evaluate.x0

    @property
    def by(self) -> list[str]:
        """The params, in the order of ``x``."""
        return list(self._evaluate.by)

    def __call__(self, x: ArrayLike) -> tuple[float, Array]:
        value, gradient = self._both(x)
        lacking = [name for name, slope in zip(self.by, gradient) if np.isnan(slope)]
        if lacking:
            message = f"result `{self._name}` has no derivative by {', '.join(f'`{name}`' for name in lacking)} here"
            raise missing_value(message, "its value alone is `f.value(x)`, for methods that take no gradient")
        return value, gradient

    def _both(self, x: ArrayLike) -> tuple[float, Array]:
        try:
            results, slopes, *_ = self._evaluate(x)
            if np.isnan(results[self._place]):
                raise missing_value(f"result `{self._name}` has no value here", "`failed=` gives one to such places")
        except AnalysisError:
            if self._failed is None:
                raise
            return self._failed, np.zeros(len(self.by))
        return float(results[self._place]), slopes[self._place].copy()

    def value(self, x: ArrayLike) -> float:
        """The value alone; the gradient is computed with it, whose bits do not depend on what else is asked then."""
        return self._both(x)[0]

    def gradient(self, x: ArrayLike) -> Array:
        """The gradient alone, of shape (params,)."""
        return self(x)[1]


class Residuals:
    """Columns at some times less what they ought to be, as a function of params, with its exact derivatives.

    For ``scipy.optimize.least_squares(f, x0, jac=f.jacobian)``: ``f(x)`` is of shape (times × columns,), ``f.jacobian(x)`` of shape
    (times × columns, params); times are the outer order. Where the mechanism does not get there an error is raised, or with ``failed=10.0``
    all residuals are that. Times stay as they are, whatever the params: an analysis whose ends or step go with them is refused without ``at=``.
    """

    def __init__(self, evaluate: Evaluation, columns: list[str], wanted: Array, failed: float | None) -> None:
        self._evaluate = evaluate
        self._failed = failed
        #: The times of the first place that was asked for.
        self._times: Array | None = None
        self._columns = columns
        self._wanted = wanted
        #: The values of the params in the text, with what was set (SI).
        self.x0 = evaluate.x0

    @property
    def columns(self) -> list[str]:
        """The columns, in the order of the inner index."""
        return list(self._columns)

    @property
    def by(self) -> list[str]:
        """The params, in the order of ``x``."""
        return list(self._evaluate.by)

    def _both(self, x: ArrayLike) -> tuple[Array, Array]:
        try:
            evaluated = self._evaluate(x)
            if self._times is None:
                self._times = self._times_that_stay(x, evaluated.times)
        except AnalysisError:
            if self._failed is None:
                raise
            return np.full(self._wanted.size, self._failed), np.zeros((self._wanted.size, len(self.by)))
        if not np.array_equal(evaluated.times, self._times):
            raise _times_move()
        if evaluated.rows.shape != self._wanted.shape:
            raise usage(f"there are {len(evaluated.times)} times, and targets for {self._wanted.shape[0]}")
        return (evaluated.rows - self._wanted).ravel(), evaluated.slopes_of_rows.reshape(-1, len(self.by))

    def _times_that_stay(self, x: ArrayLike, times: Array) -> Array:
        """Returns the times; refuses times that change with the params, which the derivatives do not take into account."""
        if not self._evaluate.has_own_times:
            with contextlib.suppress(AnalysisError):
                if not np.array_equal(self._evaluate(np.asarray(elements("x", x)) * (1 + BESIDE) + BESIDE).times, times):
                    raise _times_move()
        return times

    def __call__(self, x: ArrayLike) -> Array:
        return self._both(x)[0]

    def jacobian(self, x: ArrayLike) -> Array:
        """The derivatives of all residuals by all params."""
        # who gets them may change them
        return self._both(x)[1].copy()


#: Step, relative and in SI, of the second point at which the times of an analysis are compared.
BESIDE = 1e-6


def _times_move() -> UsageError:
    return usage("the times of the analysis go with the params, and targets are for times that stay", "say them: `at=[0.0, 0.1, …]`")


class Evaluated(NamedTuple):
    """The output of an evaluation."""

    #: Of shape (results,).
    results: Array
    #: By the params: of shape (results, params).
    slopes: Array
    #: Of shape (times,) (s).
    times: Array
    #: Of shape (times, columns).
    rows: Array
    #: By the params: of shape (times, columns, params).
    slopes_of_rows: Array


class Evaluation:
    """Results and columns with their derivatives at values of params; the last of them is kept, since optimisers ask for value and
    derivatives one after the other."""

    def __init__(self, m: Mechanism, by: Any, columns: Sequence[str], request: dict[str, Any]) -> None:
        self.by = _names(by)
        self._arguments = m, self.by, columns, request
        params = _params(m, self.by, request["set"])
        for name in self.by:
            if name not in params:
                copies = names_of(name, params)
                help = f"as in `by={copies!r}`" if copies else suggestion(name, params) or f"the params are {', '.join(params)}"
                raise usage(f"`{name}` is several params" if copies else f"there is no param `{name}`", help)
        self.x0 = np.array([params[name] for name in self.by])
        self.x0.setflags(write=False)
        patterns = [*columns, *(f"{column}.by.{name}" for column in columns for name in self.by), "t"]
        request = {**request, "by": self.by, "slopes": True, "columns": patterns}
        self._evaluator = m._evaluator(request, self.by)
        places = {name: place for place, name in enumerate(self._evaluator.columns)}
        self._time = places["t"]
        #: Whether times are asked for, which stay whatever the params.
        self.has_own_times = bool(request["at"])
        self._columns = [places[column] for column in columns]
        self._slopes = [[places[f"{column}.by.{name}"] for name in self.by] for column in columns]
        self.results = [name for name, _ in self._evaluator.results]
        self.results = self.results[: len(self.results) // (len(self.by) + 1)]
        self._last: tuple[bytes, Evaluated] | None = None

    def __call__(self, x: ArrayLike) -> Evaluated:
        x = np.asarray(elements("x", x))
        if x.size != len(self.by):
            raise usage(f"{x.size} values are given for {len(self.by)} params", f"these are {', '.join(self.by)}, in that order")
        x = np.ascontiguousarray(x).reshape(-1)
        if self._last is not None and self._last[0] == x.tobytes():
            return self._last[1]
        values, rows = self._evaluator.evaluate(x)
        numbers = np.array([np.nan if value is None else value for value in values], dtype=float)
        own = len(self.results)
        if not len(numbers):
            # times alone have no results
            numbers = np.full(own * (1 + len(self.by)), np.nan)
        evaluated = Evaluated(
            numbers[:own],
            numbers[own:].reshape(own, len(self.by)),
            rows[:, self._time],
            rows[:, self._columns],
            rows[:, self._slopes] if self._columns else np.empty((len(rows), 0, len(self.by))),
        )
        self._last = x.tobytes(), evaluated
        return evaluated

    def __reduce__(self) -> tuple[Any, ...]:
        # it is compiled anew where it is unpacked
        return Evaluation, self._arguments


def _params(m: Mechanism, by: Sequence[str], set: Sequence[str]) -> Mapping[str, float]:
    """The params of a mechanism of which some are set, and others are to be varied (SI)."""
    names = [setting.partition("=")[0] for setting in set]
    for name in by:
        if name in names:
            raise usage(f"`{name}` is set, and is one of the params that `x` holds", "leave it out of one of the two: optimisers begin where you say")
    if not names:
        return m.params
    text, path, files, mechanism, own, leaves_out = m._pickled()
    kept = [setting for setting in own if setting.partition("=")[0] not in names]
    return type(m)(text, path, files, False, mechanism, [*kept, *set], leaves_out).params


def objective(m: Mechanism, result: str, by: Any, failed: float | None, request: dict[str, Any]) -> Objective:
    """A result as a function of params."""
    evaluation = Evaluation(m, by, [], request)
    if result not in evaluation.results:
        hint = suggestion(result, evaluation.results) or "add one: `results={'stroke': 'max(x(P)) - min(x(P))'}`"
        raise usage(f"there is no result `{result}`", hint)
    return Objective(evaluation, evaluation.results.index(result), failed)


def residuals(
    m: Mechanism, columns: Any, wanted: ArrayLike, by: Any, failed: float | None, request: dict[str, Any]
) -> Residuals:
    """Columns less what they ought to be, as a function of params."""
    names = texts("columns", columns)
    known = m.columns
    for name in names:
        if name not in known:
            raise usage(f"there is no column `{name}`", suggestion(name, known))
    if not names:
        raise usage("it is not said of which columns", "as in `m.residuals(['px', 'py'], points, by=…)`")
    # what the caller does with theirs later is of no concern here
    targets = np.array(elements("wanted", wanted))
    targets = targets.reshape(-1, len(names)) if targets.ndim == 1 and targets.size % len(names) == 0 else targets
    if targets.ndim != 2 or targets.shape[1] != len(names):
        raise usage(f"targets of shape {targets.shape} are given for {len(names)} columns", "a row for each time is wanted")
    return Residuals(Evaluation(m, by, names, request), names, targets, failed)
