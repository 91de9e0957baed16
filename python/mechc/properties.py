"""The properties of a mechanism: names, values and units."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

from mechc import _mechc, requests


class MechanismProperties(_mechc.Mechanism):
    """A mechanism with the properties that its text gives."""

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

    def _request(self, values: Mapping[str, Any], **given: Any) -> dict[str, Any]:
        """Returns the options of a run; ``values`` are the keywords that are params and inputs."""
        return requests.run_request(self._param_units, self._input_units, values, **given)
