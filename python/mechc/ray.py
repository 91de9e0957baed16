"""Sweeps that outgrow a machine, as Ray Data pipelines: shares of the variants, a file for each.

Any variant is computed from its number alone, so that a share is a range of numbers, and the shares, put in order, are the sweep of one
machine, to the bit, whatever workers died on the way. Ray hands them out, tries again what was lost, and knows the machines; nothing here
schedules or transports.
"""

from __future__ import annotations

import functools
import json
import os
import pickle
import uuid
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mechc._mechc import __version__
from mechc.asking import flag, with_options
from mechc.running import Running
from mechc.sweep import Sweep
from mechc.values import path_of, usage, whole

if TYPE_CHECKING:
    import pyarrow
    import pyarrow.fs

    from mechc.mechanism import Mechanism

#: The file that says what the whole is.
WHOLE = "sweep.json"

#: Variants of a share, unless it is said: some seconds of work, and files that are neither many nor huge.
SHARE = 10_000


@dataclass(frozen=True)
class Shares:
    """A sweep in a folder, made by :func:`sweep`."""

    #: The folder, as it was named.
    folder: str
    #: How many variants the whole has.
    count: int
    #: The shares, each the first variant and the one behind the last.
    ranges: tuple[tuple[int, int], ...]
    #: How many shares this call made; the others were there.
    made: int

    @property
    def files(self) -> list[str]:
        """The files of the shares, in order."""
        return [f"{self.folder.rstrip('/')}/{_name(first, last)}" for first, last in self.ranges]

    def to_arrow(self) -> pyarrow.Table:
        """All shares, put in order: the sweep of one machine."""
        import pyarrow
        from pyarrow import parquet

        fs, root = _opened(self.folder)
        return pyarrow.concat_tables(parquet.read_table(f"{root}/{_name(*of)}", filesystem=fs) for of in self.ranges)


@functools.partial(with_options, like=[Running.sweep])
def sweep(
    m: Mechanism,
    /,
    *,
    out: str | os.PathLike[str],
    share: int = SHARE,
    concurrency: int | None = None,
    progress: bool = False,
    **options: Any,
) -> Shares:
    """Computes a sweep with Ray, and writes it into a folder: ``part-FIRST-LAST.parquet`` for each share, and ``sweep.json``.

    ``options`` are those of :meth:`mechc.Mechanism.sweep`: ``vary``, ``samples``, ``seed``, ``rows``, ``results`` and so on, but for
    ``jobs``, ``skip``, ``take``, ``until`` and ``progress``. ``out`` may be on any file system that pyarrow opens (``s3://…``); all
    workers must reach it. ``share`` is how many variants a task computes, on one core. ``concurrency`` bounds how many tasks run at once.

    A file is written beside its place and renamed, so that what stands there is whole. A second call with the same sweep makes what is
    missing; with another one it is refused. A Ray that runs is used, or one is started.
    """
    import ray
    import ray.data

    whole_sweep, share = _whole(m, options), whole("share", share, 1)
    concurrency = None if concurrency is None else whole("concurrency", concurrency, 1)
    # workers may stand in other folders
    name = path_of("out", out)
    name = name if "://" in name else os.path.abspath(name)
    fs, root = _opened(name)
    fs.create_dir(root, recursive=True)
    count = whole_sweep.variants
    told = {
        "mechc": __version__,
        "mechanism": m.name,
        "variants": count,
        "share": share,
        "columns": [{"name": column, "unit": unit} for column, unit in whole_sweep.units.items()],
        "sweep": _fingerprint(whole_sweep),
    }
    _tell(fs, root, told)
    ranges = [(first, min(first + share, count)) for first in range(0, count, share)]
    there = _there(fs, root)
    missing = [of for of in ranges if _name(*of) not in there]
    if missing:
        packed = ray.put(pickle.dumps(whole_sweep))
        context = ray.data.DataContext.get_current()
        shown = context.enable_progress_bars
        context.enable_progress_bars = flag("progress", progress)
        try:
            rows = [{"first": first, "last": last} for first, last in missing]
            shares = ray.data.from_items(rows, override_num_blocks=len(rows))
            # within a list a reference is handed on as it is, and fetched once by each worker
            keywords = {"packed": [packed], "folder": name}
            compute = ray.data.TaskPoolStrategy(size=concurrency)
            made = shares.map(_make, fn_kwargs=keywords, num_cpus=1, compute=compute)
            done = sum(row["made"] for row in made.iter_rows())
        finally:
            context.enable_progress_bars = shown
        if done != len(missing):
            raise RuntimeError(f"Ray gave {done} shares of {len(missing)}")
        _clear(fs, root, missing)
    return Shares(name, count, tuple(ranges), len(missing))


def share(packed: bytes, first: int, last: int) -> Iterator[Any]:
    """A share as record batches, from a pickled :class:`mechc.Sweep`: for whatever hands out work, as Spark and Dask do."""
    import pyarrow

    yield from pyarrow.RecordBatchReader.from_stream(_part(pickle.loads(packed), first, last))


def _part(of: Sweep, first: int, last: int) -> Sweep:
    """Some variants of a sweep, on the one core that a task has."""
    m, asked, more, _ = of._made_of
    return Sweep(m, asked, {**more, "skip": first, "take": last - first, "jobs": 1})


def _make(row: dict[str, int], *, packed: Any, folder: str) -> dict[str, int]:
    """Makes a share, and writes its file."""
    import pyarrow
    from pyarrow import parquet

    first, last = int(row["first"]), int(row["last"])
    part = _part(_unpacked(packed), first, last)
    fs, root = _opened(folder)
    # two workers may make one share, where one was taken for dead: each writes its own, and the last to rename wins with the same bits
    beside = f"{root}/.{_name(first, last)}.{uuid.uuid4().hex}"
    try:
        reader = pyarrow.RecordBatchReader.from_stream(part)
        with fs.open_output_stream(beside) as stream, parquet.ParquetWriter(stream, reader.schema) as writer:
            for batch in reader:
                writer.write_batch(batch)
        done = sum(count for count, _ in part.summary.values())
        if done != last - first:
            raise RuntimeError(f"the share from {first} to {last} has {done} variants")
        fs.move(beside, f"{root}/{_name(first, last)}")
    except BaseException:
        if fs.get_file_info(beside).type != 0:
            fs.delete_file(beside)
        raise
    return {"first": first, "last": last, "made": 1}


#: The sweep of this worker: it is unpacked, checked and proven once for all of its shares.
_KNOWN: dict[str, Sweep] = {}


def _unpacked(packed: Any) -> Sweep:
    import ray

    (reference,) = packed
    key = reference.hex()
    if key not in _KNOWN:
        _KNOWN.clear()
        _KNOWN[key] = pickle.loads(ray.get(reference))
    return _KNOWN[key]


def _whole(m: Mechanism, options: dict[str, Any]) -> Sweep:
    for name in ("jobs", "skip", "take", "until", "progress"):
        if options.get(name) is not None:
            raise usage(f"`{name}` is not for sweeps of shares", "leave it out; `share` says how many variants a task computes")
    # what the caller names has been looked at
    found: Sweep = Running.sweep.__wrapped__(m, **options)  # type: ignore[attr-defined]
    for option in found._made_of[2]["vary"]:
        if option.startswith("@"):
            raise usage("variants of a file are not there for all workers", "read it, and give `variants` as a table")
    return found


def _fingerprint(of: Sweep) -> dict[str, Any]:
    """What decides each bit of a sweep, as JSON."""
    import hashlib

    m, asked, more, _ = of._made_of
    text, _, files, mechanism, set, allow_redundant = m._packed()
    contents = {str(path): hashlib.sha256(contents).hexdigest() for path, contents in sorted(files.items(), key=str)}
    lists = [hashlib.sha256(listed).hexdigest() for listed in more["lists"]]
    return {
        "text": hashlib.sha256(text.encode()).hexdigest(),
        "files": contents,
        "choice": {"mechanism": mechanism, "set": set, "allow_redundant": allow_redundant},
        "asked": _said(asked),
        "variants": {**_said(more), "lists": lists},
    }


def _said(options: dict[str, Any]) -> dict[str, Any]:
    """What of options was said; a number 0 was."""
    return {name: value for name, value in options.items() if value is not None and value is not False and value != []}


def _tell(fs: pyarrow.fs.FileSystem, root: str, told: dict[str, Any]) -> None:
    """Says what the whole is; refuses a folder of another one."""
    place = f"{root}/{WHOLE}"
    if fs.get_file_info(place).type != 0:
        with fs.open_input_stream(place) as stream:
            known = json.loads(stream.read())
        if known != json.loads(json.dumps(told)):
            differ = [key for key in told if known.get(key) != json.loads(json.dumps(told[key]))]
            raise usage(f"the folder holds another sweep: {', '.join(differ)} differ", "name another folder")
        return
    if any(name.startswith("part-") for name in _there(fs, root)):
        raise usage(f"the folder has shares and no `{WHOLE}` that says what of", "name another folder")
    beside = f"{root}/.{WHOLE}.{uuid.uuid4().hex}"
    with fs.open_output_stream(beside) as stream:
        stream.write(json.dumps(told, indent=1).encode())
    fs.move(beside, place)


def _there(fs: pyarrow.fs.FileSystem, root: str) -> set[str]:
    from pyarrow.fs import FileSelector

    return {info.base_name for info in fs.get_file_info(FileSelector(root, allow_not_found=True))}


def _clear(fs: pyarrow.fs.FileSystem, root: str, made: list[tuple[int, int]]) -> None:
    """Removes what workers that died have left beside shares that others have made since."""
    left = tuple(f".{_name(*of)}." for of in made)
    for name in _there(fs, root):
        if name.startswith(left):
            fs.delete_file(f"{root}/{name}")


def _opened(folder: str) -> tuple[pyarrow.fs.FileSystem, str]:
    """The file system of a folder, and its path there."""
    from pyarrow.fs import FileSystem

    place = folder if "://" in folder else os.path.abspath(folder)
    fs, root = FileSystem.from_uri(place)
    return fs, root.rstrip("/")


def _name(first: int, last: int) -> str:
    return f"part-{first:012}-{last:012}.parquet"

