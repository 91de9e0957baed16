"""Refuses computations that do not fit into free memory before they begin, since a system that overcommits kills the process later."""

from __future__ import annotations

import os

from mechc.errors import TooLarge
from mechc.values import usage

#: Help for each kind of computation: how to need less memory.
_INSTEAD = {
    "run": "ask for fewer columns (`columns=…`), or for fewer times (`every=…`, `at=…`)",
    "sweep": "read it batch by batch: `for batch in pyarrow.RecordBatchReader.from_stream(sweep)`; "
    "or take a share: `skip=K, take=N`; or fewer columns (`columns=…`)",
    "block": "variants are computed side by side, some on each thread: ask for fewer columns (`columns=…`) or times (`every=…`), "
    "or for fewer threads (`jobs=1`)",
    "at": "ask for fewer elements at once",
}

#: Rows up to this size are not checked (bytes).
SMALL = 64 << 20

#: Least number of columns of a mechanism: the time, and the three coordinates of a body with both derivatives.
LEAST = 10

#: Files with limit, usage and statistics of the control group of this process, of both versions.
_GROUPS = (
    ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current", "/sys/fs/cgroup/memory.stat"),
    (
        "/sys/fs/cgroup/memory/memory.limit_in_bytes",
        "/sys/fs/cgroup/memory/memory.usage_in_bytes",
        "/sys/fs/cgroup/memory/memory.stat",
    ),
)


def refuse_beyond(rows: int, columns: int, of: str) -> None:
    """Refuses rows of numbers that do not fit into the memory that is free."""
    free = _free()
    if free is not None and 8 * rows * columns > free:
        raise too_large(rows, columns, of, free)


def refuse_elements(count: int) -> None:
    """Refuses elements that do not fit into free memory, whatever the mechanism."""
    if 8 * count * LEAST > SMALL:
        free = _free()
        if free is not None and 8 * count * LEAST > free:
            raise too_many(count, free)


def too_many(count: int, free: int | None = None) -> TooLarge:
    """Returns the error for elements that do not fit into memory, before their number of columns is known."""
    return too_large(count, LEAST, "at", free, " or more")


def too_large(rows: int, columns: int, of: str, free: int | None = None, more: str = "") -> TooLarge:
    """Returns the error for rows of numbers that do not fit into memory."""
    beside = "" if free is None else f", and {_size(max(free, 0))} of memory are free"
    message = f"{rows} rows of {columns} columns{more} take {_size(8 * rows * columns)}{more}{beside}"
    error = usage(message, _INSTEAD[of], TooLarge)
    error.diagnostics[0]["data"] = {"rows": rows, "columns": columns, "bytes": 8 * rows * columns}
    return error  # type: ignore[return-value]


def _free() -> int | None:
    """Returns the number of free bytes; ``None`` if it is not known."""
    known = [free for free in (_of_machine(), *map(_of_group, _GROUPS), _of_process()) if free is not None]
    return min(known, default=None)


def _of_machine() -> int | None:
    for line in _read("/proc/meminfo").splitlines():
        if line.startswith("MemAvailable:"):
            return 1024 * int(line.split()[1])
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return None


def _of_group(files: tuple[str, str, str]) -> int | None:
    limit, used = (_read(file).strip() for file in files[:2])
    if not (limit.isdigit() and used.isdigit()):
        return None
    # files that are only remembered give way
    remembered = [line.split()[1] for line in _read(files[2]).splitlines() if line.startswith("inactive_file ")]
    return int(limit) - int(used) + sum(map(int, remembered[:1]))


def _of_process() -> int | None:
    try:
        import resource
    except ImportError:
        return None
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    used = _read("/proc/self/statm").split()
    if limit == resource.RLIM_INFINITY or not used:
        return None
    return limit - int(used[0]) * resource.getpagesize()


def _read(file: str) -> str:
    try:
        with open(file, encoding="ascii") as text:
            return text.read()
    except (OSError, ValueError):
        return ""


def _size(bytes: int) -> str:
    """Formats a number of bytes."""
    for of, unit in ((10**12, "TB"), (10**9, "GB"), (10**6, "MB")):
        if bytes >= of:
            count = bytes / of
            return f"{count:.1e} {unit}" if count >= 1e4 else f"{count:.3g} {unit}"
    return f"{bytes} bytes"
