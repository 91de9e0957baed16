"""What can go wrong, as exceptions: each says what the command would print, and has the same as data.

``str(error)`` is the printed text, with the lines of the ``.mech`` file that it speaks of. ``error.diagnostics`` is a list of
dictionaries, one for each message, as ``mechc --message-format json`` writes them: ``code``, ``severity``, ``message``, ``labels`` with
places (lines and columns count from 1), ``notes``, ``help``, ``fixes``, ``data``.

========================  =====================================================================
:class:`InputError`       the text has errors
:class:`UsageError`       something was asked for that cannot be (also a :class:`ValueError`)
:class:`TooLarge`         of these: it takes more memory than there is (also a :class:`MemoryError`)
:class:`FileError`        a file could not be read or written (also an :class:`OSError`)
:class:`AnalysisError`    the analysis could not be completed; ``partial`` has what there is
:class:`LockUp`           of these: the mechanism locks up, at ``time``
:class:`NotAssembled`     of these: it cannot be assembled
:class:`Bifurcation`      of these: two branches of the motion meet
========================  =====================================================================
"""

from __future__ import annotations

import errno
import json
import os
import sys
import warnings
from typing import Any


__all__ = [
    "AnalysisError",
    "Bifurcation",
    "FileError",
    "InputError",
    "LockUp",
    "MechcError",
    "MechcWarning",
    "NotAssembled",
    "TooLarge",
    "UsageError",
]


class MechcError(Exception):
    """Something went wrong; ``diagnostics`` say what, each as a dictionary, and ``str()`` as the command prints it."""

    #: What is said, a dictionary for each message.
    diagnostics: list[dict[str, Any]]

    def __init__(self, text: str = "", diagnostics: list[dict[str, Any]] | None = None) -> None:
        super().__init__(text)
        self.text = text
        self.diagnostics = [] if diagnostics is None else diagnostics

    def __str__(self) -> str:
        return self.text

    @property
    def code(self) -> str | None:
        """The code of the first error, ``'E0602'``."""
        codes = (of["code"] for of in self.diagnostics if of.get("severity") == "error")
        return next(codes, None)

    @property
    def element(self) -> tuple[int, ...] | None:
        """Which element it is of those that :meth:`mechc.Mechanism.at` was asked for, as their array is indexed; nothing of one alone."""
        found = self._datum("element")
        return None if found is None else tuple(found)

    def _datum(self, name: str) -> Any:
        """Returns a datum of the first error."""
        found = (of.get("data", {}).get(name) for of in self.diagnostics if of.get("severity") == "error")
        return next(found, None)

    def __reduce__(self) -> tuple[Any, ...]:
        # `partial` may refer to the error itself, so the state is restored after the object exists
        return type(self), (self.text, self.diagnostics), dict(self.__dict__)


class InputError(MechcError):
    """The text of a mechanism has errors, or it is not determined."""


class UsageError(MechcError, ValueError):
    """Something was asked for that cannot be: an unknown param, a value that is none, options that do not go together."""


class TooLarge(UsageError, MemoryError):
    """What is asked for takes more memory than there is: it says how many rows, columns and bytes that are, and how to have less at once."""


class FileError(MechcError, OSError):
    """A file could not be read or written; ``filename`` is which, ``errno`` and ``strerror`` what the system says of it, if it says anything."""

    def __init__(self, text: str = "", diagnostics: list[dict[str, Any]] | None = None) -> None:
        super().__init__(text, diagnostics)
        data = next((of["data"] for of in self.diagnostics if "file" in of.get("data", {})), {})
        self.filename = data.get("file")
        self.errno = data.get("errno")
        if self.errno in errno.errorcode:
            self.strerror = os.strerror(self.errno)


class AnalysisError(MechcError):
    """The analysis could not be completed; what there is up to there is ``partial``."""

    #: What was computed before it stopped: a :class:`mechc.Run` or :class:`mechc.At`, or the path of a page; nothing where it did not begin.
    partial: Any = None

    @property
    def time(self) -> float | None:
        """When it stopped (s), where that is known."""
        return self._datum("t")


class LockUp(AnalysisError):
    """The mechanism locks up: a driver drives into a dead point (E0602)."""


class NotAssembled(AnalysisError):
    """The mechanism cannot be assembled at its first time (E0601)."""


class Bifurcation(AnalysisError):
    """Two branches of the motion meet (E0603); ``pass_bifurcations=True`` goes on along the smooth one."""


class MechcWarning(UserWarning):
    """Something is worth knowing, and nothing is wrong; ``diagnostics`` has it as data."""

    #: What is said, a dictionary for each message.
    diagnostics: list[dict[str, Any]]

    def __init__(self, text: str, diagnostics: list[dict[str, Any]] | None = None) -> None:
        super().__init__(text)
        self.diagnostics = [] if diagnostics is None else diagnostics


_CLASSES_BY_KIND = {"input": InputError, "usage": UsageError, "analysis": AnalysisError, "files": FileError}
_CLASSES_BY_CODE = {"E0601": NotAssembled, "E0602": LockUp, "E0603": Bifurcation}


#: The folder of the package, whose frames are not the user's.
_PACKAGE = os.path.dirname(os.path.abspath(__file__)) + os.sep


def warn(warning: MechcWarning) -> None:
    """Warns at the line that calls into the package, however deep within it this is called."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        frame, level = frame.f_back, level + 1
    warnings.warn(warning, stacklevel=level)


def _parsed(lines: list[str]) -> list[dict[str, Any]]:
    """Parses diagnostics."""
    return [json.loads(line) for line in lines]


def _exception_from(lines: list[str], text: str, kind: str, code: str) -> MechcError:
    """Returns the exception for diagnostics of the library."""
    diagnostics = _parsed(lines)
    # if the continuation and the assembly from the estimates both fail, the code of the latter comes second
    codes = [code, *(of["code"] for of in diagnostics if of["severity"] == "error")]
    cls = next((_CLASSES_BY_CODE[code] for code in codes if code in _CLASSES_BY_CODE), _CLASSES_BY_KIND.get(kind, MechcError))
    return cls(text, diagnostics)


def _warn(lines: list[str], text: str) -> None:
    """Issues diagnostics as a warning."""
    warn(MechcWarning(text, _parsed(lines)))
