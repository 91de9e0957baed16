"""Motions of a mechanism, one or many."""

from __future__ import annotations

import functools
import os
from collections.abc import Mapping
from typing import Any

from mechc import requests
from mechc.requests import flag, with_options
from mechc.properties import MechanismProperties
from mechc.sweep import Sweep
from mechc.tables import Run
from mechc.values import Value, first_duplicate, texts, usage

#: More variants than this are asked about, as the command does.
MANY = 1_000_000_000


class Running(MechanismProperties):
    """A mechanism that can be run."""

    @with_options
    def run(
        self,
        /,
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
        ``strict=False`` they are given, and ``run.status`` says why it stopped. Where no way leads to what is set or told, it is assembled
        from the text's estimates, which may be another branch: that is a warning, and ``run.status`` is ``"reassembled"``.
        """
        request = self._request(
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
        return self._execute(request, flag("strict", strict))

    def _execute(self, request: dict[str, Any], is_strict: bool) -> Run:
        output = self._run(request)
        run = Run(output["table"], self.name, output["results"], output["status"], output["stopped"], output["error"])
        return _unless(is_strict, run)

    @with_options
    def sweep(
        self,
        /,
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
        yes: bool = False,
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
        variants are done and how many there are. More than 10⁹ variants are computed with ``yes=True`` alone. The other options are those of
        :meth:`run`.
        """
        request = self._request(
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
        variation = requests.sweep_request(
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
            request=request,
        )
        sweep, is_meant = Sweep(self, request, variation, progress), flag("yes", yes)
        twice = first_duplicate(sweep.columns)
        if twice is not None:
            help = "the table has columns of its own: `variant`, `status`, `stopped`; give that param or result another name"
            raise usage(f"two columns of the table would be called `{twice}`", help)
        if sweep.variants > MANY and not is_meant:
            help = "add `yes=True` if that is meant, or take a share with `skip=K, take=N`"
            raise usage(f"these are {sweep.variants} variants", help)
        return sweep

    @functools.partial(with_options, like=[run])
    def reactions(self, /, **options: Any) -> Run:
        """What all joints exert and all drivers supply, as ``mechc run --reactions`` has it: ``main.fx``, ``main.fy``, ``motor.effort``.

        It takes what :meth:`run` takes, and gives those columns alone, behind the time; with ``by`` their derivatives too. Forces are in
        the outermost frame (N, N*m).
        """
        is_strict, columns = flag("strict", options.pop("strict", True)), texts("columns", options.get("columns"))
        # what the caller names has been looked at, and what is named here is none of the caller's
        request = {**options, "strict": False, "reactions": True, "columns": columns or None}
        run = Running.run.__wrapped__(self, **request)  # type: ignore[attr-defined]
        if not columns:
            plain = {*self.columns}
            names = [name for name in run if name == "t" or run._derived(name)[0] not in plain]
            run = run._with_columns(names)
        return _unless(is_strict, run)


def _unless(is_strict: bool, run: Run) -> Run:
    """A run, unless it stopped and that is an error."""
    if run.error is not None and is_strict:
        run.error.partial = run
        raise run.error
    return run

