"""Plots with matplotlib, which need not be there for anything else."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from mechc.values import texts, usage

if TYPE_CHECKING:
    from mechc.tables import Run


def over_time(run: Run, columns: Sequence[str | Iterable[str]], ax: Any = None) -> Any:
    """Columns over time. Those of one unit share the scale on the left; those of a second one have a scale on the right."""
    try:
        from matplotlib import pyplot
    except ImportError:
        raise ImportError("plots need matplotlib: pip install 'mechc[plot]'") from None
    names = [name for one in columns for name in texts("columns", one)]
    if columns and not names:
        raise usage("`columns` holds no name", "leave it out for all measures")
    names = names or _measures(run)
    if not names:
        raise usage("there is no measure to plot", "name columns, as in `run.plot('crank.phi')`")
    values = {name: run[name] for name in names}
    units = list(dict.fromkeys(run.units[name] for name in names))
    if len(units) > 2:
        raise usage(
            f"columns of {len(units)} units do not go into one plot: {', '.join(units)}",
            "plot them one after the other: `run.plot('travel'); run.plot('travel.dd')`",
        )
    if ax is None:
        _, ax = pyplot.subplots(layout="constrained")
    axes = [ax] + ([ax.twinx()] if len(units) == 2 else [])
    for k, name in enumerate(names):
        axes[units.index(run.units[name])].plot(run.t, values[name], label=name, color=f"C{k % 10}")
    for axis, unit in zip(axes, units):
        axis.set_ylabel(", ".join(name for name in names if run.units[name] == unit) + ("" if unit == "1" else f" [{unit}]"))
    ax.set_xlabel("t [s]")
    lines = [line for axis in axes for line in axis.get_lines()]
    if len(names) > 1:
        ax.legend(lines, [line.get_label() for line in lines])
    if run.stopped is not None:
        ax.axvline(run.stopped, color="0.5", linestyle=":")
    return ax


def _measures(run: Run) -> list[str]:
    """What is neither time, coordinate nor derivative."""
    return [name for name in run if name != "t" and "." not in name]
