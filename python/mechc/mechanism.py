"""A mechanism: a text that was checked, proven determined and compiled once, for all that is asked of it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

from mechc import _mechc, asking, exports, notebook
from mechc.derivatives import Jacobian, Objective, Residuals, jacobian, objective, residuals
from mechc.errors import MechcError
from mechc.sweep import Sweep
from mechc.tables import Run
from mechc.tolerances import Tolerance, told
from mechc.values import Value, many, number, texts, usage, whole

#: What files hold: texts or bytes.
Files = Mapping[Any, "str | bytes"]


def load(
    path: str | os.PathLike[str],
    *,
    mechanism: str | None = None,
    set: Mapping[str, Value] | None = None,
    allow_redundant: bool = False,
) -> Mechanism:
    """Reads, checks and proves the mechanism of a ``.mech`` file.

    ``mechanism`` names one where the file has several. ``set`` sets params, for all that is asked of it. ``allow_redundant`` leaves out
    equations that follow from others. What is wrong with the text is an :class:`mechc.InputError`, which prints what the command prints;
    what is worth knowing is a :class:`mechc.MechcWarning`.
    """
    try:
        path = os.fsdecode(os.fspath(path))
    except TypeError:
        raise usage(f"{path!r} is no path", "use `mechc.parse(text)` for a text") from None
    return _made(None, path, {}, True, mechanism, set, allow_redundant)


def parse(
    text: str,
    *,
    files: Files | None = None,
    name: str = "mechanism.mech",
    mechanism: str | None = None,
    set: Mapping[str, Value] | None = None,
    allow_redundant: bool = False,
) -> Mechanism:
    """The same of a text; ``files`` are those that it names, by their paths, and ``name`` is what messages call it."""
    if not isinstance(text, str):
        raise usage(f"a text is wanted, and this is an object of {type(text).__name__}", "use `mechc.load(path)` for a file")
    held = {}
    for path, contents in (files or {}).items():
        if not isinstance(contents, (str, bytes)):
            raise usage(f"the file {path!r} is an object of {type(contents).__name__}", "give its text, or its bytes")
        held[os.fsdecode(os.fspath(path))] = contents.encode() if isinstance(contents, str) else contents
    return _made(text, name, held, False, mechanism, set, allow_redundant)


def _made(
    text: str | None,
    path: str,
    files: dict[str, bytes],
    from_disk: bool,
    mechanism: str | None,
    set: Mapping[str, Value] | None,
    allow_redundant: bool,
) -> Mechanism:
    if mechanism is not None and not isinstance(mechanism, str):
        raise usage(f"{mechanism!r} is no name of a mechanism")
    given = []
    if set:
        # which unit a number has is known when the mechanism is
        plain = Mechanism(text, path, files, from_disk, mechanism, [], allow_redundant)
        given = asking.settings(set, {}, plain._param_units)
    return Mechanism(text, path, files, from_disk, mechanism, given, allow_redundant)


class Mechanism(_mechc.Mechanism):
    """A mechanism that is determined; :func:`mechc.load` and :func:`mechc.parse` make one.

    It never changes: threads may share it, and what is asked of it with other params is asked of a copy. It is pickled as its text, the
    files that it read, and its settings.
    """

    @property
    def name(self) -> str:
        """Its name in the text."""
        return self._name

    @property
    def params(self) -> dict[str, float]:
        """Its params with their values (SI), those of parts by their paths; ``m.units`` has their units."""
        return {name: value for name, value, _ in self._params}

    @property
    def inputs(self) -> dict[str, float]:
        """Its inputs with what they are at the first time (SI)."""
        return {name: value for name, value, _ in self._inputs}

    @cached_property
    def _param_units(self) -> dict[str, str]:
        return {name: unit for name, _, unit in self._params}

    @cached_property
    def _input_units(self) -> dict[str, str]:
        return {name: unit for name, _, unit in self._inputs}

    @property
    def columns(self) -> list[str]:
        """The columns of a run: ``t``, coordinates, measures, and the first (``.d``) and second (``.dd``) derivatives of all."""
        return self._columns()

    @property
    def results(self) -> list[str]:
        """The names of its results, numbers for the whole analysis."""
        return [name for name, _ in self._results]

    @property
    def units(self) -> dict[str, str]:
        """The units of columns as they are tabulated, and the SI units of params, inputs and results; ``"1"`` for a pure number."""
        units = dict(zip(self._columns(), self._units))
        for name, _, unit in [*self._params, *self._inputs]:
            units.setdefault(name, unit or "1")
        for name, unit in self._results:
            units.setdefault(name, unit)
        return units

    def run(
        self,
        *,
        set: Mapping[str, Value] | None = None,
        inputs: Mapping[str, Value] | None = None,
        samples: str | os.PathLike[str] | None = None,
        from_: Value | None = None,
        to: Value | None = None,
        every: Value | None = None,
        at: Any = None,
        columns: Any = None,
        results: Any = None,
        by: Any = None,
        reactions: bool = False,
        lead: bool = False,
        tolerance: float | None = None,
        pass_bifurcations: bool = False,
        allow_redundant: bool = False,
        strict: bool = True,
        **values: Value,
    ) -> Run:
        """The motion, as ``mechc run`` has it: the same columns, units and bits.

        Params and inputs may be given by their names, ``rod_length="180 mm"``; an option's name wins, and ``set`` and ``inputs`` take any:
        ``set={"leg[1].la": "180 mm"}``. An input is a number, or a formula of ``t``: ``swing="20 deg * sin(1 rev/s * t)"``; ``samples``
        names a CSV file of them. Numbers are SI (times in s), texts have units.

        ``from_``, ``to``, ``every`` and ``at`` say which times; ``columns`` chooses by patterns (``"tip.*"``); ``results`` adds results
        (``{"stroke": "max(x(P)) - min(x(P))"}``); ``by`` adds the derivatives of all columns by params and inputs; ``reactions`` what all
        joints exert and all drivers supply; ``lead`` assembles with the text's own params and leads over to those that are set, along
        the branch. ``tolerance`` bounds each row of the equations; ``pass_bifurcations`` goes on where branches meet.

        A motion that stops raises (:class:`mechc.LockUp`, :class:`mechc.AnalysisError`), with the rows up to there as ``partial``; with
        ``strict=False`` they are given, and ``run.status`` says why it stopped.
        """
        asked = asking.asked(
            self._param_units,
            self._input_units,
            _RUN,
            values,
            set=set,
            inputs=inputs,
            samples=samples,
            from_=from_,
            to=to,
            every=every,
            at=at,
            columns=columns,
            results=results,
            by=by,
            reactions=reactions,
            lead=lead,
            tolerance=tolerance,
            pass_bifurcations=pass_bifurcations,
            allow_redundant=allow_redundant,
        )
        return self._ran(asked, strict)

    def _ran(self, asked: dict[str, Any], strict: bool) -> Run:
        told = self._run(asked)
        run = Run(told["table"], self.name, told["results"], told["code"], told["stopped"], told["error"])
        if run.error is not None and strict:
            run.error.partial = run
            raise run.error
        return run

    def sweep(
        self,
        vary: Any = None,
        *,
        variants: Any = None,
        samples: int | None = None,
        method: str | None = None,
        seed: int | None = None,
        rows: bool = False,
        until: str | None = None,
        set: Mapping[str, Value] | None = None,
        inputs: Mapping[str, Value] | None = None,
        from_: Value | None = None,
        to: Value | None = None,
        every: Value | None = None,
        at: Any = None,
        columns: Any = None,
        results: Any = None,
        by: Any = None,
        reactions: bool = False,
        tolerance: float | None = None,
        pass_bifurcations: bool = False,
        allow_redundant: bool = False,
        jobs: int | None = None,
        skip: int = 0,
        take: int | None = None,
        progress: Any = None,
        **values: Value,
    ) -> Sweep:
        """Many variants, as ``mechc sweep`` computes them: an Arrow stream, which is computed while it is read.

        ``vary`` says which params vary: ``{"rod_length": mechc.between("100 mm", "200 mm", 50), "speed": ["60 rpm", "90 rpm"]}``, all
        combinations, the last param the fastest; ranges without a number are sampled: ``samples=100_000``, by ``method`` ``"sobol"`` (the
        default) or ``"random"``, with ``seed``. ``variants`` is a table instead or beside, a column for each param: a mapping to arrays
        (SI), a frame, or the path of a CSV file.

        A row for each variant: ``variant``, its params, all results (SI), ``status`` (``ok``, ``reassembled``, or the code that stopped
        it) and ``stopped`` (s). With ``rows=True`` the whole motion of each instead, of which ``columns`` and ``at`` choose. ``until``
        ends behind the first variant with a condition: ``"stroke > 80 mm"``. ``skip`` and ``take`` compute a share; shares, put together,
        are the whole, to the bit. ``jobs`` threads compute. ``progress`` is ``True`` for a line on standard error, or called with how many
        variants are done and how many there are. The other options are those of :meth:`run`.
        """
        asked = asking.asked(
            self._param_units,
            self._input_units,
            _SWEEP,
            values,
            set=set,
            inputs=inputs,
            from_=from_,
            to=to,
            every=every,
            at=at,
            columns=columns,
            results=results,
            by=by,
            reactions=reactions,
            tolerance=tolerance,
            pass_bifurcations=pass_bifurcations,
            allow_redundant=allow_redundant,
        )
        more = asking.varied(
            self._param_units,
            vary,
            variants,
            samples=samples,
            method=method,
            seed=seed,
            rows=rows,
            until=until,
            jobs=jobs,
            skip=skip,
            take=take,
            asked=asked,
        )
        return Sweep(self, asked, more, progress)

    def _asked(self, options: tuple[str, ...] | list[str], values: Mapping[str, Any], **given: Any) -> dict[str, Any]:
        return asking.asked(self._param_units, self._input_units, options, values, **given)

    def reactions(self, *, strict: bool = True, **options: Any) -> Run:
        """What all joints exert and all drivers supply, as ``mechc run --reactions`` has it: ``main.fx``, ``main.fy``, ``motor.effort``.

        It takes what :meth:`run` takes, and gives those columns alone, behind the time. Forces are in the outermost frame (N, N*m).
        """
        columns = texts("columns", options.pop("columns", None))
        run = self.run(strict=False, reactions=True, columns=columns, **options)
        if not columns:
            plain = {*self.columns}
            names = [name for name in run if name == "t" or (name not in plain and ".by." not in name)]
            run = run._with_columns(names)
        if run.error is not None and strict:
            run.error.partial = run
            raise run.error
        return run

    def jacobian(
        self,
        by: Any,
        *,
        set: Mapping[str, Value] | None = None,
        inputs: Mapping[str, Value] | None = None,
        from_: Value | None = None,
        to: Value | None = None,
        every: Value | None = None,
        results: Any = None,
        lead: bool = False,
        tolerance: float | None = None,
        pass_bifurcations: bool = False,
        **values: Value,
    ) -> Jacobian:
        """The exact derivatives of all results and columns by params and inputs, ``by=["rod_length"]``.

        ``j.results`` is of shape (results, params), in SI; ``j["travel"]`` of shape (rows, params), along the motion. The options are
        those of :meth:`run`.
        """
        asked = self._asked(
            _JACOBIAN,
            values,
            set=set,
            inputs=inputs,
            from_=from_,
            to=to,
            every=every,
            results=results,
            lead=lead,
            tolerance=tolerance,
            pass_bifurcations=pass_bifurcations,
        )
        return jacobian(self, by, asked)

    def objective(
        self,
        result: str,
        by: Any,
        *,
        failed: float | None = None,
        set: Mapping[str, Value] | None = None,
        from_: Value | None = None,
        to: Value | None = None,
        every: Value | None = None,
        results: Any = None,
        tolerance: float | None = None,
        pass_bifurcations: bool = False,
        **values: Value,
    ) -> Objective:
        """A result as a function of params, with its exact gradient, for optimisers.

        ``f = m.objective("peak", by=["rod_length", "crank_length"])``, then ``scipy.optimize.minimize(f, f.x0, jac=True)``. ``x`` are the
        params in that order (SI); the mechanism is led from its own params to them, along the branch, so that a value does not depend
        on those that were asked for before. ``failed`` is the value where it does not get there; an error is raised where nothing is said.
        """
        asked = self._asked(
            _OBJECTIVE,
            values,
            set=set,
            from_=from_,
            to=to,
            every=every,
            results=results,
            tolerance=tolerance,
            pass_bifurcations=pass_bifurcations,
        )
        if not isinstance(result, str):
            raise usage(f"{result!r} is no name of a result")
        return objective(self, result, by, None if failed is None else float(failed), asked)

    def residuals(
        self,
        columns: Any,
        wanted: Any,
        by: Any,
        *,
        failed: float | None = None,
        set: Mapping[str, Value] | None = None,
        from_: Value | None = None,
        to: Value | None = None,
        every: Value | None = None,
        at: Any = None,
        tolerance: float | None = None,
        pass_bifurcations: bool = False,
        **values: Value,
    ) -> Residuals:
        """Columns at some times less what they ought to be, as a function of params, with exact derivatives.

        ``f = m.residuals(["px", "py"], points, by=["r1", "r2"], at=times)``, ``points`` of shape (times, columns), in the columns' units;
        then ``scipy.optimize.least_squares(f, f.x0, jac=f.jacobian)``. ``at`` must rise. ``failed`` is
        what all residuals are where it does not get there; an error is raised where nothing is said.
        """
        if at is not None and len(many("at", at)) > 1:
            times = [number("at", time) for time in many("at", at)]
            if any(a >= b for a, b in zip(times, times[1:])):
                raise usage("the times of `at` do not rise", "each is to stand once, in order, as its target does")
        asked = self._asked(
            _RESIDUALS,
            values,
            set=set,
            from_=from_,
            to=to,
            every=every,
            at=at,
            tolerance=tolerance,
            pass_bifurcations=pass_bifurcations,
        )
        return residuals(self, columns, wanted, by, None if failed is None else float(failed), asked)

    def tolerance(
        self,
        tol: Mapping[str, Any],
        *,
        normal: bool = False,
        verify: bool = False,
        set: Mapping[str, Value] | None = None,
        inputs: Mapping[str, Value] | None = None,
        from_: Value | None = None,
        to: Value | None = None,
        every: Value | None = None,
        results: Any = None,
        tolerance: float | None = None,
        pass_bifurcations: bool = False,
        **values: Value,
    ) -> Tolerance:
        """What small errors of params make of measures and results, as ``mechc tolerance`` says it.

        ``tol`` says how far they may be off: ``{"rod_length": "0.05 mm", "A.x": ("-0.1 mm", 0)}``, plus and minus, or from and to; numbers are
        SI. The contribution of each comes from exact derivatives; errors are uniform within their tolerance, or with ``normal=True`` it
        is 3 σ. ``verify`` runs the corners, and says where derivatives are not enough.
        """
        if not isinstance(tol, Mapping) or not tol:
            raise usage("`tol` says which params may be off", "as in `tol={'rod_length': '0.05 mm'}`")
        asked = self._asked(
            _TOLERANCE,
            values,
            set=set,
            inputs=inputs,
            from_=from_,
            to=to,
            every=every,
            results=results,
            tolerance=tolerance,
            pass_bifurcations=pass_bifurcations,
        )
        listed = [asking.off(name, ends, asking.unit_of(name, self._param_units)) for name, ends in tol.items()]
        return told(*self._tolerance(asked, listed, bool(normal), bool(verify)))

    def to_rust(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        sensitivities: bool = False,
        lanes: int | None = None,
        ffi: bool = False,
    ) -> str | Path:
        """Rust code that assembles the mechanism and follows its motion, as ``mechc emit`` writes it.

        The text where no path is given; a ``.rs`` file, or a whole crate in a folder. ``sensitivities`` adds derivatives by params,
        ``lanes`` so many variants at once, ``ffi`` a header for C, to a crate.
        """
        asked = {
            "sensitivities": bool(sensitivities),
            "lanes": None if lanes is None else whole("lanes", lanes, 1),
            "ffi": bool(ffi),
        }
        if path is None or exports.path_of(path).suffix == ".rs":
            if ffi:
                raise usage("functions for C are a part of a crate", "name a folder for it")
            text = self._rust(asked)
            return text if path is None else self._written(path, text)
        folder = exports.path_of(path)
        files, mark = self._crate(asked, folder.resolve().name or self.name)
        return exports.write_all(folder, files, mark)

    def to_latex(self, path: str | os.PathLike[str] | None = None) -> str | Path:
        """The equations typeset for a report: the text, or a file."""
        text = self._latex()
        return text if path is None else self._written(path, text)

    def to_json(self, path: str | os.PathLike[str] | None = None) -> str | Path:
        """The constraint system as data for other programs: the text, or a file."""
        text = self._json()
        return text if path is None else self._written(path, text)

    def view(
        self,
        path: str | os.PathLike[str],
        *,
        set: Mapping[str, Value] | None = None,
        inputs: Mapping[str, Value] | None = None,
        from_: Value | None = None,
        to: Value | None = None,
        every: Value | None = None,
        pass_bifurcations: bool = False,
        **values: Value,
    ) -> Path:
        """Writes a page that moves (``.html``), or a picture that does (``.svg``), of a run with these options."""
        file = exports.path_of(path)
        if file.suffix not in (".html", ".svg"):
            raise usage(f"`{file}` is neither a page nor a picture", "its ending is `.html` or `.svg`")
        asked = self._asked(
            _VIEW, values, set=set, inputs=inputs, from_=from_, to=to, every=every, pass_bifurcations=pass_bifurcations
        )
        page, picture = self._seen(asked)
        return self._written(file, page if file.suffix == ".html" else picture)

    def _written(self, path: str | os.PathLike[str], text: str) -> Path:
        """Writes a file, which is none that it was read from."""
        file = exports.path_of(path)
        _, own, used, *_ = self._packed()
        exports.refuse_what_was_read(file, [own, *used])
        return exports.write(file, text)

    def _repr_html_(self) -> str | None:
        """The moving page, for notebooks."""
        try:
            return notebook.shown(self, self._asked([], {}))
        except MechcError:
            return None

    def __repr__(self) -> str:
        moved = len([name for name in self._columns() if name.endswith(".x")])
        params = f", {len(self._params)} params" if self._params else ""
        inputs = f", {len(self._inputs)} inputs" if self._inputs else ""
        return f"<Mechanism {self.name}: {moved} bodies{params}{inputs}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, self._packed()

    def __copy__(self) -> Mechanism:
        return self

    def __deepcopy__(self, memo: Any) -> Mechanism:
        return self


def _again(
    text: str, path: Any, files: dict[Any, bytes], mechanism: str | None, set: list[str], allow_redundant: bool
) -> Mechanism:
    return Mechanism(text, path, files, False, mechanism, set, allow_redundant)


_RUN = (
    "set inputs samples from_ to every at columns results by reactions lead tolerance pass_bifurcations allow_redundant strict"
).split()
_SWEEP = (
    "vary variants samples method seed rows until set inputs from_ to every at columns results by reactions tolerance "
    "pass_bifurcations allow_redundant jobs skip take progress"
).split()
_JACOBIAN = "by set inputs from_ to every results lead tolerance pass_bifurcations".split()
_OBJECTIVE = "result by failed set from_ to every results tolerance pass_bifurcations".split()
_RESIDUALS = "columns wanted by failed set from_ to every at tolerance pass_bifurcations".split()
_TOLERANCE = "tol normal verify set inputs from_ to every results tolerance pass_bifurcations".split()
_VIEW = "path set inputs from_ to every pass_bifurcations".split()
