"""Planar mechanisms from text: proven determined, analysed, swept by the hundred thousand, with exact derivatives.

>>> import mechc
>>> m = mechc.load("slider_crank.mech")
>>> run = m.run(rod_length="180 mm", every="0.5 ms")
>>> run["piston.x"]                    # a numpy array (m), without a copy

Whatever is computed has the bits of the command ``mechc``. Numbers that are handed over are in SI (m, rad, s, kg, N); texts have units
(``"180 mm"``). Mechanisms never change, may be shared by threads, and can be pickled; the arrays of runs and sweeps cannot be written to, those
of ``at`` belong to who asks. While something is computed no lock is held, and Ctrl-C ends it.
"""

import sysconfig as _sysconfig

if _sysconfig.get_config_var("Py_GIL_DISABLED"):
    raise ImportError(
        "mechc is not made for free-threaded Python: use an interpreter with the lock (python3.13 instead of python3.13t); "
        "mechc holds no lock while it computes, so threads gain as much there"
    )

from mechc._mechc import __version__  # noqa: E402
from mechc.errors import (  # noqa: E402
    AnalysisError,
    Bifurcation,
    FileError,
    InputError,
    LockUp,
    MechcError,
    MechcWarning,
    NotAssembled,
    TooLarge,
    UsageError,
)
from mechc.mechanism import Mechanism, load, parse  # noqa: E402
from mechc._mechc import At  # noqa: E402
from mechc.derivatives import Jacobian, Objective, Residuals  # noqa: E402
from mechc.sweep import Sweep  # noqa: E402
from mechc.tables import Run, Swept  # noqa: E402
from mechc.tolerances import Deviation, Tolerance  # noqa: E402
from mechc.values import Between, between  # noqa: E402


def __getattr__(name: str) -> object:
    # what needs Ray is there once it is asked for
    if name == "ray":
        import importlib

        return importlib.import_module("mechc.ray")
    raise AttributeError(f"module 'mechc' has no attribute {name!r}")


__all__ = [
    "AnalysisError",
    "At",
    "Between",
    "Bifurcation",
    "Deviation",
    "FileError",
    "InputError",
    "Jacobian",
    "LockUp",
    "MechcError",
    "MechcWarning",
    "Mechanism",
    "NotAssembled",
    "Objective",
    "Residuals",
    "Run",
    "Sweep",
    "Swept",
    "Tolerance",
    "TooLarge",
    "UsageError",
    "__version__",
    "between",
    "load",
    "parse",
]
