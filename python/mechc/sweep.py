"""Sweeps as Arrow streams."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any

from mechc.tables import Swept
from mechc.values import usage, whole_number

if TYPE_CHECKING:
    import polars
    import pandas

    from mechc.mechanism import Mechanism


class Sweep:
    """Many variants of a mechanism, made by :meth:`mechc.Mechanism.sweep`.

    It is an Arrow stream that is computed while it is read, each time anew: ``polars.DataFrame(sweep)``, ``pyarrow.table(sweep)``,
    ``pyarrow.RecordBatchReader.from_stream(sweep)`` batch by batch, in bounded memory. ``sweep.read()`` gives all of it as numpy columns.
    """

    def __init__(self, mechanism: Mechanism, request: dict[str, Any], variation: dict[str, Any], progress: Any = None) -> None:
        if progress not in (None, False, True) and not callable(progress):
            raise usage(f"`progress` is {progress!r}", "give `True`, or a function of how many variants are done and how many there are")
        self._arguments = mechanism, request, variation, progress
        self._sweep = mechanism._sweep(request, variation)

    @property
    def columns(self) -> list[str]:
        """The names of its columns."""
        return list(self._sweep.names)

    @property
    def units(self) -> dict[str, str]:
        """The units of its columns: SI for params and results, as tabulated for rows."""
        return dict(zip(self._sweep.names, self._sweep.units))

    def __len__(self) -> int:
        """How many variants it computes."""
        return len(self._sweep)

    @property
    def variants(self) -> int:
        """How many variants it computes, be they more than ``len`` can say."""
        return self._sweep.taken

    @property
    def summary(self) -> dict[str, tuple[int, int]]:
        """Of what was read last, by status: how many variants, and the number of the first of them."""
        return dict(self._sweep.summary)

    def settings(self, variant: int) -> dict[str, str]:
        """The params of a variant, as ``set`` takes them, those among them that are set for all: ``m.run(lead=True, set=sweep.settings(7))`` is
        its motion, to the bit."""
        texts = [*self._arguments[1]["set"], *self._sweep.settings(whole_number("variant", variant))]
        return dict(text.split("=", 1) for text in texts)

    def read(self) -> Swept:
        """Computes all of it: its columns as numpy arrays, of shape (rows,). What does not fit into memory is refused
        (:class:`mechc.TooLarge`): as a stream it is read batch by batch."""
        return Swept(self._sweep._table(self._progress_callback()))

    def to_polars(self) -> polars.DataFrame:
        """All of it as a polars frame."""
        import polars

        return self.read().to_polars()

    def to_pandas(self) -> pandas.DataFrame:
        """All of it as a pandas frame."""
        return self.read().to_pandas()

    def __arrow_c_schema__(self) -> object:
        return self._sweep.__arrow_c_schema__()

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._sweep._stream(self._progress_callback())

    def _progress_callback(self) -> Any:
        progress = self._arguments[3]
        if progress is True:
            # programs without a console have no standard error
            return _Line() if sys.stderr is not None else None
        return progress or None

    def __repr__(self) -> str:
        return f"<Sweep of {self._made_of[0].name}: {len(self)} variants, {len(self.columns)} columns>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Sweep, self._arguments


class _Line:
    """Progress as a line on standard error."""

    def __init__(self) -> None:
        self.began = time.monotonic()
        self.shown = 0.0

    def __call__(self, done: int, count: int) -> None:
        now = time.monotonic()
        if now - self.shown < 0.2 and done < count:
            return
        self.shown = now
        rate = done / max(now - self.began, 1e-9)
        left = (count - done) / rate if rate else 0.0
        sys.stderr.write(f"\r{done} of {count} variants, {rate:.0f} a second, {left:.0f} s left \x1b[K" + ("\n" if done >= count else ""))
        sys.stderr.flush()
