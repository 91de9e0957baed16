"""Files that are written whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
import tempfile
from collections.abc import Iterable
from pathlib import Path

from mechc import values
from mechc.errors import FileError
from mechc.values import diagnostic_of

#: Lines of a file that may hold the mark by which one that was written here is known.
HEAD = 6


def path_of(path: str | os.PathLike[str]) -> Path:
    """A path that was handed over, of what is to be written."""
    name = values.path_of("path", path)
    if not name:
        # it would be taken for the folder that we are in
        raise values.usage("`path` is empty, and that of a file or folder is wanted", "`'.'` is the folder that you are in")
    return Path(name)


def write(path: Path, text: str) -> Path:
    """Replaces a file whole, or leaves it as it is: what a link leads to, with the rights that it has. A pipe or a device is written into."""
    try:
        if _is_open_already(path) or (path.exists() and not path.is_file() and not path.is_dir()):
            with open(path, "a", encoding="utf-8", newline="\n") as file:
                file.write(text)
        else:
            _replace(Path(os.path.realpath(path)), text)
    except OSError as error:
        raise _cannot(path, error.strerror or str(error), number=error.errno) from error
    return path


def _is_open_already(path: Path) -> bool:
    """Whether a path means what the process has open, whatever that is: it is no place in a folder, where a file could be replaced."""
    return str(path) in ("/dev/stdout", "/dev/stderr") or str(path).startswith(("/dev/fd/", "/proc/self/fd/"))


def _replace(path: Path, text: str) -> None:
    """Replaces a file, or makes it, and its folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    old = path.stat() if path.exists() else None
    if old is not None and not old.st_mode & 0o222:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    handle, beside = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
        if old is not None and hasattr(os, "chown"):
            # where this process may
            with contextlib.suppress(OSError):
                os.chown(beside, old.st_uid, old.st_gid)
        os.chmod(beside, 0o666 & ~_umask() if old is None else stat.S_IMODE(old.st_mode) & 0o777)
        os.replace(beside, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(beside)
        raise


def refuse_what_was_read(path: Path, sources: Iterable[str | os.PathLike[str]]) -> None:
    """Refuses to write over one of the files that a mechanism was read from."""
    for source in sources:
        try:
            is_one = os.path.samefile(path, source)
        except OSError:
            # one of them is not there
            continue
        if is_one:
            raise _cannot(path, "the mechanism was read from it", "name another file")


def write_all(folder: Path, files: list[tuple[str, str]], mark: str) -> Path:
    """Writes files into a folder; what is there already is replaced only if it has the mark."""
    for name, _ in files:
        path = folder / name
        if path.is_symlink() or path.exists():
            with contextlib.suppress(OSError):
                if path.is_file() and any(mark in line for line in path.read_text(encoding="utf-8", errors="replace").splitlines()[:HEAD]):
                    continue
            raise _cannot(path, "a file is there that mechc did not write", "name a new folder, or one that mechc wrote")
    for name, text in files:
        write(folder / name, text)
    return folder


def _cannot(path: Path, why: str, help: str | None = None, number: int | None = None) -> FileError:
    return FileError(*diagnostic_of("E0702", f"cannot write `{path}`: {why}", help, {"file": str(path), "errno": number}))


def _umask() -> int:
    found = os.umask(0)
    os.umask(found)
    return found
