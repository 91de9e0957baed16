"""Deviations of measures and results that tolerances of params cause."""

from __future__ import annotations

from collections.abc import ItemsView, Iterator, KeysView, ValuesView
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    import pandas
    import polars


class _Fixed(dict[str, Any]):
    """A dictionary that stays as it is, since all who ask are given the same; `dict(…)` of it is one's own."""

    def _refuse(self, *_: Any, **__: Any) -> NoReturn:
        raise TypeError("what was found cannot be changed: `dict(…)` makes a copy that can")

    __setitem__ = __delitem__ = __ior__ = clear = pop = popitem = setdefault = update = _refuse  # type: ignore[assignment]

    def __hash__(self) -> int:  # type: ignore[override]
        return hash(frozenset(self.items()))

    def __reduce__(self) -> tuple[Any, ...]:
        return _Fixed, (dict(self),)


@dataclass(frozen=True)
class Deviation:
    """A measure, at the time of its largest deviation, or a result; all numbers are SI.

    ``slopes`` are the exact derivatives by each param, ``contributions`` what the tolerance of each makes of it, from the least to the
    largest, ``shares`` its part of the variance. ``worst`` is the sum of all at their worst, ``statistical`` the root of the sum of squares,
    ``sigma`` the standard deviation. Where it was verified ``found`` is how far it was off, ``missing`` in how many variants it has no value,
    and ``is_linear`` whether derivatives are enough.
    """

    name: str
    at: float | None
    nominal: float
    unit: str
    slopes: dict[str, float | None]
    contributions: dict[str, tuple[float, float]] | None
    shares: dict[str, float] | None
    worst: tuple[float, float] | None
    statistical: tuple[float, float] | None
    sigma: float | None
    found: tuple[float, float] | None = None
    missing: int | None = None
    is_linear: bool | None = None


@dataclass(frozen=True)
class Tolerance:
    """What tolerances make of a mechanism, made by :meth:`mechc.Mechanism.tolerance`; ``tolerance["stroke"]`` is a :class:`Deviation`.

    ``dict(tolerance)`` has them by their names; ``tolerance.to_pandas()``, ``to_polars()`` and ``to_dict()`` are a table, a row for each.
    """

    #: Of each param: how far it may be below and above (SI).
    ranges: dict[str, tuple[float, float]]
    #: Of each measure and result, by its name.
    deviations: dict[str, Deviation] = field(repr=False)
    #: How many variants were run to verify it; nothing where it was not asked for.
    variants: int | None = None
    #: Whether these were all corners.
    are_all_corners: bool | None = None
    #: How many of them did not come to their end on the branch.
    lost: int | None = None

    def __getitem__(self, name: str) -> Deviation:
        return self.deviations[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.deviations)

    def __len__(self) -> int:
        return len(self.deviations)

    def keys(self) -> KeysView[str]:
        """The names of the measures and results."""
        return self.deviations.keys()

    def values(self) -> ValuesView[Deviation]:
        """What is known of each."""
        return self.deviations.values()

    def items(self) -> ItemsView[str, Deviation]:
        """Both."""
        return self.deviations.items()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NoReturn:
        # its names alone, as what iterates over it would have them, are what nobody means
        raise TypeError("deviations are no array of numbers: `to_pandas()`, `to_polars()` and `to_dict()` give a table of them")

    def to_dict(self) -> dict[str, list[Any]]:
        """A row for each measure and result, by columns."""
        rows = list(self.deviations.values())
        table: dict[str, list[Any]] = {
            "name": [row.name for row in rows],
            "unit": [row.unit for row in rows],
            "t": [row.at for row in rows],
            "nominal": [row.nominal for row in rows],
        }
        for param in self.ranges:
            table[f"by {param}"] = [row.slopes[param] for row in rows]
        for end, word in enumerate(("least", "most")):
            table[f"worst {word}"] = [row.worst and row.worst[end] for row in rows]
            table[f"statistical {word}"] = [row.statistical and row.statistical[end] for row in rows]
        table["sigma"] = [row.sigma for row in rows]
        return table

    def to_polars(self) -> polars.DataFrame:
        """The same as a polars frame."""
        import polars

        return polars.DataFrame(self.to_dict())

    def to_pandas(self) -> pandas.DataFrame:
        """The same as a pandas frame."""
        import pandas

        return pandas.DataFrame(self.to_dict())


def tolerance_of(params: list[Any], quantities: list[dict[str, Any]], tried: Any) -> Tolerance:
    """Creates the result from that of the library."""
    names = [name for name, *_ in params]

    def by_param(values: Any) -> Any:
        return None if values is None else _Fixed(zip(names, (tuple(v) if isinstance(v, list) else v for v in values)))

    def pair(values: Any) -> Any:
        return None if values is None else tuple(values)

    deviations = _Fixed({
        of["name"]: Deviation(
            name=of["name"],
            at=of["at"],
            nominal=of["nominal"],
            unit=of["unit"],
            slopes=by_param(of["slopes"]),
            contributions=by_param(of["contributions"]),
            shares=by_param(of["shares"]),
            worst=pair(of["worst"]),
            statistical=pair(of["statistical"]),
            sigma=of["sigma"],
            found=pair(of["found"]),
            missing=of["missing"],
            is_linear=of["is_linear"],
        )
        for of in quantities
    })
    variants, are_all, lost = tried or (None, None, None)
    ranges = _Fixed({name: tuple(range_) for name, _, range_, _ in params})
    return Tolerance(ranges, deviations, variants, are_all, lost)
