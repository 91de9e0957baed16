"""A mechanism: a text that was checked, proven determined and compiled once, for all that is asked of it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mechc import exports, notebook, requests
from mechc._mechc import seconds
from mechc.requests import with_options
from mechc.derivatives import Jacobian, Objective, Residuals, jacobian, objective, residuals
from mechc.errors import MechcError, MechcWarning, warn
from mechc.running import Running
from mechc.tolerances import Tolerance, tolerance_of
from mechc.values import Value, as_list, checked_text, mapping, number, path_of, usage, whole_number

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
    file = path_of("path", path, "use `mechc.parse(text)` for a text")
    return _made(None, file, {}, True, mechanism, set, allow_redundant)


def parse(
    text: str,
    *,
    files: Files | None = None,
    name: str | os.PathLike[str] = "mechanism.mech",
    mechanism: str | None = None,
    set: Mapping[str, Value] | None = None,
    allow_redundant: bool = False,
) -> Mechanism:
    """The same of a text; ``files`` are those that it names, by their paths, and ``name`` is what messages call it."""
    if not isinstance(text, str):
        raise usage(f"a text is wanted, and this is an object of {type(text).__name__}", "use `mechc.load(path)` for a file")
    held = {}
    for path, contents in ({} if files is None else _listed(files)).items():
        if not isinstance(contents, (str, bytes, bytearray, memoryview)):
            raise usage(f"the file {path!r} is an object of {type(contents).__name__}", "give its text, or its bytes")
        name_of_it = path_of("files", path)
        held[name_of_it] = checked_text(name_of_it, contents).encode() if isinstance(contents, str) else bytes(contents)
    return _made(checked_text("text", text), path_of("name", name), held, False, mechanism, set, allow_redundant)


def _listed(files: Any) -> Mapping[Any, Any]:
    if not isinstance(files, Mapping):
        raise usage(f"`files` is an object of {type(files).__name__}, and a mapping from paths is wanted", "as in `files={'leg.mech': text}`")
    return files


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
    if mechanism is not None:
        checked_text("mechanism", mechanism)
    given, leaves_out = [], requests.flag("allow_redundant", allow_redundant)
    if set is not None and mapping("set", set):
        # which unit a number has is known when the mechanism is
        plain = Mechanism(text, path, files, from_disk, mechanism, [], leaves_out)
        given = requests.settings("set", set, {}, plain._param_units)
    return Mechanism(text, path, files, from_disk, mechanism, given, leaves_out)


class Mechanism(Running):
    """A mechanism that is determined; :func:`mechc.load` and :func:`mechc.parse` make one.

    It never changes: threads may share it, and what is asked of it with other params is asked of a copy. It is pickled as its text, the
    files that it read, and its settings.
    """

    @with_options
    def jacobian(
        self,
        /,
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

        ``j.results`` is of shape (results, params), in SI; ``j["travel"]`` of shape (rows, params), along the motion. Its options are
        those that :meth:`run` has by the same names.
        """
        request = self._request(
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
        return jacobian(self, by, request)

    @with_options
    def objective(
        self,
        /,
        result: str,
        by: Any,
        *,
        failed: float | None = None,
        set: Mapping[str, Value] | None = None,
        inputs: Mapping[str, Value] | None = None,
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
        request = self._request(
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
        if not isinstance(result, str):
            raise usage(f"{result!r} is no name of a result")
        return objective(self, checked_text("result", result), by, _replacing(failed), request)

    @with_options
    def residuals(
        self,
        /,
        columns: Any,
        wanted: Any,
        by: Any,
        *,
        failed: float | None = None,
        set: Mapping[str, Value] | None = None,
        inputs: Mapping[str, Value] | None = None,
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
        at = None if at is None else as_list("at", at)
        if at is not None and len(at) > 1:
            times = [seconds(time) if isinstance(time, str) else number("at", time) for time in at]
            if any(a >= b for a, b in zip(times, times[1:])):
                raise usage("the times of `at` do not rise", "each is to stand once, in order, as its target does")
        request = self._request(
            values,
            set=set,
            inputs=inputs,
            from_=from_,
            to=to,
            every=every,
            at=at,
            tolerance=tolerance,
            pass_bifurcations=pass_bifurcations,
        )
        return residuals(self, columns, wanted, by, _replacing(failed), request)

    @with_options
    def tolerance(
        self,
        /,
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
        ends = mapping("tol", tol)
        if not ends:
            raise usage("`tol` says which params may be off", "as in `tol={'rod_length': '0.05 mm'}`")
        request = self._request(
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
        listed = [requests.tolerance_option(name, ends, requests.unit_of(name, self._param_units)) for name, ends in ends.items()]
        is_normal, is_verified = requests.flag("normal", normal), requests.flag("verify", verify)
        return tolerance_of(*self._tolerance(request, listed, is_normal, is_verified))

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
        request = {
            "sensitivities": requests.flag("sensitivities", sensitivities),
            "lanes": None if lanes is None else whole_number("lanes", lanes, 1),
            "ffi": requests.flag("ffi", ffi),
        }
        if path is None or exports.path_of(path).suffix == ".rs":
            if ffi:
                raise usage("functions for C are a part of a crate", "name a folder for it")
            text = self._rust(request)
            return text if path is None else self._written(path, text)
        folder = exports.path_of(path)
        files, mark = self._crate(request, folder.resolve().name or self.name)
        return exports.write_all(folder, files, mark)

    def to_latex(self, path: str | os.PathLike[str] | None = None) -> str | Path:
        """The equations typeset for a report: the text, or a file."""
        text = self._latex()
        return text if path is None else self._written(path, text)

    def to_json(self, path: str | os.PathLike[str] | None = None) -> str | Path:
        """The constraint system as data for other programs: the text, or a file."""
        text = self._json()
        return text if path is None else self._written(path, text)

    @with_options
    def view(
        self,
        /,
        path: str | os.PathLike[str],
        *,
        set: Mapping[str, Value] | None = None,
        inputs: Mapping[str, Value] | None = None,
        from_: Value | None = None,
        to: Value | None = None,
        every: Value | None = None,
        pass_bifurcations: bool = False,
        strict: bool = True,
        **values: Value,
    ) -> Path:
        """Writes a page that moves (``.html``), or a picture that does (``.svg``), of a run with these options.

        A motion that stops is shown up to there, one that cannot be assembled as it comes nearest to that. Why is raised behind that, as
        :meth:`run` raises it, with the path as ``partial``; with ``strict=False`` it is a warning.
        """
        file, is_strict = exports.path_of(path), requests.flag("strict", strict)
        if file.suffix not in (".html", ".svg"):
            raise usage(f"`{file}` is neither a page nor a picture", "its ending is `.html` or `.svg`")
        request = self._request(
            values, set=set, inputs=inputs, from_=from_, to=to, every=every, pass_bifurcations=pass_bifurcations
        )
        page, picture, error = self._visualize(request)
        written = self._written(file, page if file.suffix == ".html" else picture)
        if error is not None and is_strict:
            error.partial = written
            raise error
        if error is not None:
            warn(MechcWarning(str(error), error.diagnostics))
        return written

    def _written(self, path: str | os.PathLike[str], text: str) -> Path:
        """Writes a file, which is none that it was read from."""
        file = exports.path_of(path)
        _, own, used, *_ = self._pickled()
        exports.refuse_what_was_read(file, [own, *used])
        return exports.write(file, text)

    def _repr_html_(self) -> str:
        """The moving page, for notebooks, with why the motion stops, if it does; where there is no motion, why there is none."""
        try:
            return notebook.shown(self, self._request({}))
        except MechcError as error:
            return notebook.without_motion(self, error)

    def __repr__(self) -> str:
        moved = len([name for name in self._columns() if name.endswith(".x")])
        params = f", {len(self._params)} params" if self._params else ""
        inputs = f", {len(self._inputs)} inputs" if self._inputs else ""
        return f"<Mechanism {self.name}: {moved} bodies{params}{inputs}>"

    def __setattr__(self, name: str, value: Any) -> None:
        known = name in self._param_units or name in self._input_units
        instead = f"`m.run({name}=…)` asks with another value" if known else "it is what its text says"
        raise AttributeError(f"a mechanism does not change: {instead}")

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickle, self._pickled()

    def __copy__(self) -> Mechanism:
        return self

    def __deepcopy__(self, memo: Any) -> Mechanism:
        return self


def _unpickle(
    text: str, path: Any, files: dict[Any, bytes], mechanism: str | None, set: list[str], allow_redundant: bool
) -> Mechanism:
    return Mechanism(text, path, files, False, mechanism, set, allow_redundant)


def _replacing(failed: Any) -> float | None:
    """What stands for places that are not reached; infinity may."""
    if failed is None:
        return None
    return float(failed) if isinstance(failed, float) else number("failed", failed)
