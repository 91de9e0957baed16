"""Tables of results: columns by their names, as numpy arrays and for whatever speaks Arrow, in the same memory."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mechc import _mechc
from mechc.values import suggestion, texts

if TYPE_CHECKING:
    import pandas
    import polars

    from mechc.errors import AnalysisError


class _Stream:
    """A table as a stream alone, for those who would take it for a mapping."""

    def __init__(self, rows: Rows) -> None:
        self._rows = rows

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._rows.__arrow_c_stream__(requested_schema)


class Rows(Mapping[str, Any]):
    """A table, a mapping from the names of its columns to their values.

    ``table["travel"]`` is a numpy array of shape (rows,) that shares the table's memory and cannot be written to. Whatever takes
    Arrow takes the table: ``table.to_polars()``, ``pyarrow.table(table)``, ``duckdb``; there a value that is missing is null, in arrays,
    and where the table is taken for a mapping, as by ``polars.DataFrame(table)``, it is ``nan``. ``numpy.asarray(table)`` are all columns
    side by side, of shape (rows, columns). That is what ``pandas.DataFrame(table)`` takes, without names: ``table.to_pandas()`` has them.
    """

    def __init__(self, table: _mechc.Table) -> None:
        self._table = table
        self._places = {name: place for place, name in enumerate(table.names)}
        self._arrays: dict[str, Any] = {}

    @property
    def columns(self) -> list[str]:
        """The names of its columns."""
        return list(self._places)

    @property
    def units(self) -> dict[str, str]:
        """The units of its columns; ``"1"`` for a pure number, empty for what has none."""
        return dict(zip(self._table.names, self._table.units))

    @property
    def shape(self) -> tuple[int, int]:
        """How many rows and columns it has."""
        return len(self._table), len(self._places)

    @property
    def rows(self) -> int:
        """How many rows it has."""
        return len(self._table)

    def __getitem__(self, name: str) -> NDArray[Any]:
        if not isinstance(name, str):
            raise KeyError(f"there is no column {name!r}; several columns are `to_numpy(['NAME', …])`")
        known = self._arrays.get(name)
        if known is not None:
            return known
        place = self._places.get(name)
        if place is None:
            hint = suggestion(name, self._places)
            raise KeyError(f"there is no column {name!r}" + (f"; {hint}" if hint else ""))
        column = self._table.column(place)
        array = np.array(column, dtype=object) if isinstance(column, list) else np.asarray(column)
        # it is given to all who ask
        array.setflags(write=False)
        self._arrays[name] = array
        return array

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name in self._places

    def __eq__(self, other: object) -> bool:
        return self is other

    __hash__ = object.__hash__

    def __arrow_c_schema__(self) -> object:
        return self._table.__arrow_c_schema__()

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._table.__arrow_c_stream__(requested_schema)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """All columns side by side, of shape (rows, columns): numbers, or objects where some hold words."""
        if copy is False:
            raise ValueError("columns lie apart in memory: side by side they are a copy")
        array = self.to_numpy(self.columns)
        return array if dtype is None else array.astype(dtype, copy=False)

    def to_numpy(self, columns: list[str] | str | None = None) -> NDArray[np.float64]:
        """Columns of numbers side by side, an array of shape (rows, columns); all of them where none are named."""
        names = [name for name in self if self[name].dtype != object] if columns is None else texts("columns", columns)
        arrays = [self[name] for name in names]
        return np.column_stack(arrays) if arrays else np.empty((self.rows, 0))

    def to_dict(self) -> dict[str, NDArray[Any]]:
        """All columns by their names."""
        return {name: self[name] for name in self}

    def to_polars(self) -> polars.DataFrame:
        """The table as a polars frame."""
        import polars

        # a mapping would be taken for one, whose missing values are NaN
        return polars.DataFrame(_Stream(self))

    def to_pandas(self) -> pandas.DataFrame:
        """The table as a pandas frame."""
        import pandas

        return pandas.DataFrame({name: np.array(self[name]) for name in self})

    def _contents(self) -> tuple[Any, ...]:
        columns = [self._table.column(place) for place in range(len(self._places))]
        plain = [column if isinstance(column, list) else np.asarray(column) for column in columns]
        return list(self._table.names), list(self._table.units), plain


def _rows(contents: tuple[Any, ...]) -> _mechc.Table:
    return _mechc.Table(*contents)


class Run(Rows):
    """The motion of a mechanism: a row for each output time, a column for each coordinate, measure and derivative.

    The columns are those of ``mechc run``, in its units: ``run.units``. ``run.t`` are the times (s), ``run.results`` the numbers for
    the whole analysis (SI), ``run.status`` is ``"ok"``, or the code of what stopped it at ``run.stopped`` (s).
    """

    def __init__(
        self,
        table: _mechc.Table,
        name: str,
        results: list[tuple[str, float | None, str]],
        status: str,
        stopped: float | None,
        error: AnalysisError | None,
    ) -> None:
        super().__init__(table)
        self._name = name
        self._results = results
        #: ``"ok"``, or the code of what stopped it: ``"E0602"``.
        self.status = status
        #: When it stopped (s); nothing where it did not.
        self.stopped = stopped
        #: Why it stopped; nothing where it did not.
        self.error = error

    @property
    def t(self) -> NDArray[np.float64]:
        """The output times (s), of shape (rows,)."""
        return self["t"]

    def _derived(self, column: str) -> tuple[str, str]:
        """Of what column this is the derivative, and by what; by nothing where it is none. A body may be called ``by`` too."""
        at = column.find(".by.")
        while at >= 0:
            if column[:at] in self:
                return column[:at], column[at + 4 :]
            at = column.find(".by.", at + 1)
        return column, ""

    @property
    def results(self) -> dict[str, float | None]:
        """The numbers for the whole analysis, in SI; nothing where one has no value."""
        return {name: value for name, value, _ in self._results}

    @property
    def result_units(self) -> dict[str, str]:
        """The SI units of the results."""
        return {name: unit for name, _, unit in self._results}

    def _with_columns(self, names: list[str]) -> Run:
        """The same with some of its columns."""
        places = [self._places[name] for name in names]
        units = self.units
        columns = [np.asarray(self._table.column(place)) for place in places]
        table = _mechc.Table(names, [units[name] for name in names], columns)
        return Run(table, self._name, self._results, self.status, self.stopped, self.error)

    def plot(self, *columns: str | Iterable[str], ax: Any = None) -> Any:
        """Columns over time, with matplotlib; all measures where none are named. Gives the axes."""
        from mechc.plots import over_time

        return over_time(self, columns, ax)

    def __repr__(self) -> str:
        rows, columns = self.shape
        ends = f", t = {self.t[0]:g} s … {self.t[-1]:g} s" if rows else ""
        state = "" if self.status == "ok" else f", stopped by {self.status}"
        return f"<Run of {self._name}: {rows} rows × {columns} columns{ends}{state}>"

    def __reduce__(self) -> tuple[Any, ...]:
        # the error may have this run for its `partial`, and comes behind it
        packed = self._contents(), self._name, self._results, self.status, self.stopped
        return _unpickle_run, packed, {"error": self.error}


def _unpickle_run(contents: tuple[Any, ...], *rest: Any) -> Run:
    return Run(_rows(contents), *rest, None)


class Swept(Rows):
    """A sweep that was computed: a row for each variant, or for each output time of each."""

    def __repr__(self) -> str:
        rows, columns = self.shape
        return f"<Swept: {rows} rows × {columns} columns>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickle_swept, (self._contents(),)


def _unpickle_swept(contents: tuple[Any, ...]) -> Swept:
    return Swept(_rows(contents))
