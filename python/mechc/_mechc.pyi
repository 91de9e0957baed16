"""The compiled module. What users call of it is :meth:`Mechanism.at` and the answer of that, :class:`At`; the rest is asked by ``mechc/*.py``.

``tests/test_types.py`` holds the names and signatures of this file against the module.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mechc.errors import AnalysisError, MechcError

__version__: str
LARGEST_FILE: int

#: A number (of one element), or an array of the elements' shape.
Numbers = float | NDArray[np.float64]
#: A number in SI, a text with its unit, or an array of such.
Given = ArrayLike | str
#: A pickled error: lines of JSON, text, kind, time (s), code.
PickledReport = tuple[list[str], str, str, float | None, str | None]

def _in_python(text: str) -> str: ...
def seconds(text: str) -> float:
    """A time with its unit (s)."""

def _at_exit() -> None:
    """Records that the interpreter exits on this thread; others do not take its lock any more."""

def _unpickle_at(
    names: list[str],
    units: list[str],
    coordinates: list[list[int]],
    rows: NDArray[np.float64],
    shape: list[int] | None,
    statuses: list[str],
    error: PickledReport | None = None,
) -> At:
    """Restores a pickled answer of :meth:`Mechanism.at`."""

@final
class At:
    """Where a mechanism is, by its columns. Of one element ``x["piston.x"]`` is a number, ``x.q`` an array of shape (coordinates,); of
    many, of a shape (…), they are arrays of the shapes (…) and (…, coordinates). Numbers are in ``x.units``; what was not reached is ``nan``."""

    def __getitem__(self, key: str, /) -> Numbers:
        """A column by its name: a number, or an array of shape (…)."""
    def __len__(self, /) -> int: ...
    def __iter__(self, /) -> Iterator[str]: ...
    def __contains__(self, key: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Callable[..., At], tuple[Any, ...]]: ...
    def keys(self) -> list[str]:
        """The names of the columns."""
    def values(self) -> list[Numbers]:
        """The columns in order."""
    def items(self) -> list[tuple[str, Numbers]]:
        """The columns with their names."""
    def get(self, key: str, default: Any = None, /) -> Any:
        """A column by its name, or what stands for one that is not there."""
    def stacked(self, names: Sequence[str]) -> NDArray[np.float64]:
        """Columns of some names side by side, of shape (…, names)."""
    @property
    def columns(self) -> list[str]:
        """The names of the columns."""
    @property
    def units(self) -> dict[str, str]:
        """The units of the columns; ``"1"`` for a pure number."""
    @property
    def coordinates(self) -> list[str]:
        """The names of the coordinates, in the order of ``q``."""
    @property
    def t(self) -> Numbers:
        """The time (s), of shape (…)."""
    @property
    def q(self) -> NDArray[np.float64]:
        """The coordinates [m, rad], of shape (…, coordinates)."""
    @property
    def qd(self) -> NDArray[np.float64]:
        """Their first derivatives by time [m/s, rad/s], of shape (…, coordinates)."""
    @property
    def qdd(self) -> NDArray[np.float64]:
        """Their second derivatives by time [m/s^2, rad/s^2], of shape (…, coordinates)."""
    @property
    def status(self) -> str | list[str]:
        """``"ok"``, or the code of why it does not get there; of many elements a list, one behind the other as in ``x.q.reshape(-1, …)``."""
    @property
    def error(self) -> MechcError | None:
        """Why the first element that does not get there does not, with its index as ``error.element``; nothing where all do."""
    @property
    def shape(self) -> tuple[int, ...]:
        """The shape (…) of the elements; ``()`` of one alone."""

class Mechanism:
    """A mechanism with its settings; users have it as :class:`mechc.Mechanism`."""

    def __new__(
        cls,
        text: str | None,
        path: str | PathLike[str],
        files: Mapping[str, bytes],
        from_disk: bool,
        mechanism: str | None,
        set: list[str],
        allow_redundant: bool,
    ) -> Any: ...
    @property
    def ndof(self) -> int:
        """Coordinates less equations: 0 of what is determined, less where redundant equations are left out."""
    @property
    def text(self) -> str:
        """The text."""
    @property
    def analysis(self) -> tuple[float, float, float] | None:
        """First time, last time and step of the text's analysis (s), if it has one."""
    @property
    def drivers(self) -> list[tuple[str, str]]:
        """Each driver with its equation as it is written."""
    @property
    def counts(self) -> str:
        """How many coordinates and equations there are, by body and declaration, as a table."""
    @property
    def _name(self) -> str: ...
    @property
    def _params(self) -> list[tuple[str, float, str]]: ...
    @property
    def _inputs(self) -> list[tuple[str, float, str]]: ...
    @property
    def _units(self) -> list[str]: ...
    @property
    def _results(self) -> list[tuple[str, str]]: ...
    def at(
        self,
        t: Given | None = None,
        *,
        set: Mapping[str, Given] | None = None,
        inputs: Mapping[str, Given] | None = None,
        rates: Mapping[str, Given] | None = None,
        accelerations: Mapping[str, Given] | None = None,
        by: str | Sequence[str] | None = None,
        reactions: bool = False,
        tolerance: float | None = None,
        pass_bifurcations: bool = False,
        strict: bool = True,
        **values: Given,
    ) -> At:
        """Where it is at given inputs, params and times (s), one element or many, which are broadcast against each other.

        ``rates`` and ``accelerations`` say how inputs move there, by their names (SI by s, by s^2). ``by`` adds the derivatives of all columns
        by inputs and params (``x["piston.x.by.theta"]``), ``reactions`` what joints exert [N, N*m] and drivers supply.
        """
    def _pickled(self) -> tuple[str, Any, dict[Any, bytes], str | None, list[str], bool]: ...
    def _columns(self) -> list[str]: ...
    def _run(self, request: dict[str, Any]) -> _RunOutput: ...
    def _sweep(self, request: dict[str, Any], variation: dict[str, Any]) -> Sweep: ...
    def _evaluator(self, request: dict[str, Any], params: list[str]) -> Evaluator: ...
    def _tolerance(self, request: dict[str, Any], tol: list[str], normal: bool, verify: bool) -> tuple[Any, Any, Any]: ...
    def _rust(self, request: dict[str, Any]) -> str: ...
    def _crate(self, request: dict[str, Any], name: str) -> tuple[list[tuple[str, str]], str]: ...
    def _latex(self) -> str: ...
    def _json(self) -> str: ...
    def _visualize(self, request: dict[str, Any], most: int | None = None) -> tuple[str, str, AnalysisError | None]: ...

class _RunOutput(TypedDict):
    """The output of a run."""

    table: Table
    results: list[tuple[str, float | None, str]]
    status: str
    stopped: float | None
    error: AnalysisError | None

@final
class Table:
    """Columns of one length, which nobody changes."""

    def __new__(cls, names: list[str], units: list[str], columns: list[Any]) -> Table: ...
    def __len__(self, /) -> int: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def units(self) -> list[str]: ...
    def column(self, number: int) -> Column | list[str]:
        """A column by its number: for numpy, of shape (rows,), or a list of words."""
    def __arrow_c_schema__(self) -> object: ...
    def __arrow_c_stream__(self, requested_schema: object = None) -> object: ...

@final
class Column:
    """A column of numbers for numpy: ``numpy.asarray(column)``, of shape (rows,), without a copy."""

    @property
    def __array_interface__(self) -> dict[str, Any]: ...
    def __len__(self, /) -> int: ...

@final
class Sweep:
    """Many variants; users have it as :class:`mechc.Sweep`."""

    def __len__(self, /) -> int: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def units(self) -> list[str]: ...
    @property
    def count(self) -> int:
        """How many variants there are, taken or not."""
    @property
    def taken(self) -> int:
        """How many variants it computes."""
    @property
    def rows_of_a_variant(self) -> int:
        """How many rows a variant has at the most."""
    @property
    def summary(self) -> dict[str, tuple[int, int]]: ...
    def settings(self, variant: int) -> list[str]: ...
    def _table(self, progress: Callable[[int, int], Any] | None = None) -> Table: ...
    def _stream(self, progress: Callable[[int, int], Any] | None = None) -> object: ...
    def __arrow_c_schema__(self) -> object: ...

@final
class Evaluator:
    """Results and rows as functions of params."""

    @property
    def columns(self) -> list[str]: ...
    @property
    def results(self) -> list[tuple[str, str]]: ...
    def evaluate(self, x: NDArray[np.float64]) -> tuple[list[float | None], NDArray[np.float64]]:
        """The results (SI), and rows of shape (times, columns), for params of shape (params,) (SI)."""
