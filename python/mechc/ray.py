"""Sweeps that outgrow a machine, as Ray Data pipelines: shares of the variants, a file for each.

Any variant is computed from its number alone, so that a share is a range of numbers, and the shares, put in order, are the sweep of one
machine, to the bit, whatever workers died on the way. Ray hands them out, tries again what was lost, and knows the machines; nothing here
schedules or transports.
"""

from __future__ import annotations

import contextlib
import functools
import json
import os
import pickle
import uuid
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from mechc._mechc import __version__
from mechc.requests import flag, with_options
from mechc.errors import FileError, MechcError
from mechc.running import Running
from mechc.sweep import Sweep
from mechc.values import diagnostic_of, path_of, usage, whole_number

if TYPE_CHECKING:
    import pyarrow
    import pyarrow.fs

    from mechc.mechanism import Mechanism

#: The file that describes the whole sweep.
WHOLE = "sweep.json"

#: Where nothing is said there are so many shares, or as many as tasks; each has so many variants at the least, for it begins with some milliseconds,
#: and so many numbers at the most, for a file is not to be huge.
SHARES, LEAST_SHARE, MOST_NUMBERS = 200, 1_000, 100_000_000

#: So many tasks a core, each of several shares where there are more: between two tasks Ray lets a core wait for some tenths of a second, and
#: where each has many the last one is not waited for long.
TASKS_OF_A_CORE = 8


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
    #: The file system that the folder is on, where one was given.
    filesystem: pyarrow.fs.FileSystem | None = field(default=None, repr=False)

    @property
    def files(self) -> list[str]:
        """The files of the shares, in order."""
        place, mark, query = self.folder.partition("?") if "://" in self.folder else (self.folder, "", "")
        return [f"{place.rstrip('/')}/{_name(first, last)}{mark}{query}" for first, last in self.ranges]

    def to_arrow(self) -> pyarrow.Table:
        """All shares, put in order: the sweep of one machine."""
        import pyarrow
        from pyarrow import parquet

        fs, root = _opened(self.folder, self.filesystem)
        return pyarrow.concat_tables(parquet.read_table(f"{root}/{_name(*of)}", filesystem=fs) for of in self.ranges)


def _of_a_mechanism(asks: Callable[..., Shares]) -> Callable[..., Shares]:
    """Decorates a function of a mechanism: any other object is refused."""

    @functools.wraps(asks)
    def wrapper(m: Mechanism, /, *arguments: Any, **keywords: Any) -> Shares:
        if not isinstance(m, Running):
            raise usage(f"an object of {type(m).__name__} is no mechanism", "`mechc.load(path)` makes one of a file")
        return asks(m, *arguments, **keywords)

    return wrapper


@_of_a_mechanism
@functools.partial(with_options, like=[Running.sweep])
def sweep(
    m: Mechanism,
    /,
    *,
    out: str | os.PathLike[str],
    filesystem: pyarrow.fs.FileSystem | None = None,
    share: int | None = None,
    concurrency: int | None = None,
    progress: bool = False,
    **options: Any,
) -> Shares:
    """Computes a sweep with Ray, and writes it into a folder: ``part-FIRST-LAST.parquet`` for each share, and ``sweep.json``.

    ``options`` are those of :meth:`mechc.Mechanism.sweep`: ``vary``, ``samples``, ``seed``, ``rows``, ``results`` and so on, but for
    ``jobs``, ``skip``, ``take``, ``until`` and ``progress``. ``out`` may be on any file system that pyarrow opens (``s3://…``), or that is given
    as ``filesystem``; all workers must reach it. ``share`` is how many variants a file has, unless it is said what the folder has, or a two-hundredth of
    them and less where there are many cores. A task computes some shares, one after the other, on one core; ``concurrency`` is how many tasks
    run at once at the most: where nothing is said, as many as Ray has cores. It is to be said where a cluster grows.

    A file is written beside its place and renamed, so that what stands there is whole. A second call with the same sweep makes what is
    missing; with another one it is refused. A Ray that runs is used, or one is started.
    """
    import ray
    import ray.data

    whole_sweep, share = _whole_sweep(m, options), None if share is None else whole_number("share", share, 1)
    concurrency = None if concurrency is None else whole_number("concurrency", concurrency, 1)
    # workers may stand in other folders
    name = path_of("out", out)
    name = name if "://" in name or filesystem is not None else os.path.abspath(name)
    fs, root = _opened(name, filesystem)
    with _file_errors(name):
        fs.create_dir(root, recursive=True)
        existing = _read_manifest(fs, root)
    count = whole_sweep.variants
    share = share or (existing["share"] if existing else _usual_share(whole_sweep, _most_tasks(concurrency)))
    manifest = {
        "mechc": __version__,
        "mechanism": m.name,
        "variants": count,
        "share": share,
        "columns": [{"name": column, "unit": unit} for column, unit in whole_sweep.units.items()],
        "sweep": _fingerprint(whole_sweep),
    }
    with _file_errors(name):
        _write_manifest(fs, root, manifest, existing)
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
            shares = ray.data.from_items(rows, override_num_blocks=min(_most_tasks(concurrency), len(rows)))
            # a task makes the shares of a block; within a list a reference is handed on as it is, and fetched once by each worker
            keywords = {"packed": [packed], "folder": name, "filesystem": filesystem}
            compute = ray.data.TaskPoolStrategy(size=concurrency)
            made = shares.map(_make, fn_kwargs=keywords, num_cpus=1, compute=compute)
            done = sum(row["made"] for row in made.iter_rows())
        finally:
            context.enable_progress_bars = shown
        if done != len(missing):
            raise RuntimeError(f"Ray gave {done} shares of {len(missing)}")
        _clear(fs, root, missing)
    return Shares(name, count, tuple(ranges), len(missing), filesystem)


def share(packed: bytes, first: int, last: int) -> Iterator[Any]:
    """A share as record batches, from a pickled :class:`mechc.Sweep`: for whatever hands out work, as Spark and Dask do. Its variants are counted
    from the first that the sweep computes: ``range(0, len(sweep), …)``."""
    import pyarrow

    of = pickle.loads(packed)
    first, last = whole_number("first", first), whole_number("last", last)
    if not first <= last <= of.variants:
        raise usage(f"there are {of.variants} variants, and a share from {first} to {last} is none of them")
    yield from pyarrow.RecordBatchReader.from_stream(_part(of, first, last))


def _usual_share(of: Sweep, tasks: int) -> int:
    """Returns the default number of variants of a file: 1, 2 or 5 times a power of ten."""
    round_ones = [digit * 10**zeros for zeros in range(20) for digit in (1, 2, 5)]
    wanted = next(share for share in round_ones if share >= max(of.variants / max(SHARES, tasks), LEAST_SHARE))
    most = MOST_NUMBERS / (of._sweep.rows_of_a_variant * len(of.columns))
    return max([share for share in round_ones if share <= min(wanted, most)], default=1)


def _most_tasks(concurrency: int | None) -> int:
    """How many tasks there are at the most, by how many run at once: on the cores of the Ray that runs, or that is started, if nothing is said."""
    import ray

    if concurrency is None:
        if not ray.is_initialized():
            ray.init()
        concurrency = max(int(ray.cluster_resources().get("CPU", 1)), 1)
    return TASKS_OF_A_CORE * concurrency


def _part(of: Sweep, first: int, last: int) -> Sweep:
    """Returns a range of the variants of a sweep, computed on one core."""
    m, request, variation, _ = of._arguments
    return Sweep(m, request, {**variation, "skip": variation["skip"] + first, "take": last - first, "jobs": 1})


def _make(row: dict[str, int], *, packed: Any, folder: str, filesystem: Any = None) -> dict[str, int]:
    """Computes a share and writes its file."""
    import pyarrow
    from pyarrow import parquet

    first, last = int(row["first"]), int(row["last"])
    fs, root = _opened(folder, filesystem)
    if fs.get_file_info(f"{root}/{_name(first, last)}").type != 0:
        # a worker died between this one and another of its shares
        return {"first": first, "last": last, "made": 1}
    part = _part(_unpacked(packed), first, last)
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


#: The sweep of this worker, unpickled and compiled once for all of its shares.
_SWEEPS: dict[str, Sweep] = {}


def _unpacked(packed: Any) -> Sweep:
    import ray

    (reference,) = packed
    key = reference.hex()
    if key not in _SWEEPS:
        _SWEEPS.clear()
        _SWEEPS[key] = pickle.loads(ray.get(reference))
    return _SWEEPS[key]


def _whole_sweep(m: Mechanism, options: dict[str, Any]) -> Sweep:
    for name in ("jobs", "skip", "take", "until", "progress"):
        if options.get(name) is not None:
            raise usage(f"`{name}` is not for sweeps of shares", "leave it out; `share` says how many variants a task computes")
    # what the caller names has been looked at
    found: Sweep = Running.sweep.__wrapped__(m, **options)  # type: ignore[attr-defined]
    return found


def _fingerprint(of: Sweep) -> dict[str, Any]:
    """Returns all inputs of a sweep that its bits depend on, as JSON; texts and files by their hashes."""
    import hashlib

    def mark(contents: bytes) -> str:
        return "sha256:" + hashlib.sha256(contents).hexdigest()

    m, request, variation, _ = of._arguments
    text, own, files, mechanism, set, allow_redundant = m._pickled()
    # wherever the text is, and from wherever it is named: what it names lies beside it
    beside = {os.path.relpath(path, os.path.dirname(own) or "."): contents for path, contents in files.items()}
    beside.pop(os.path.basename(own), None)
    vary = [of if isinstance(of, str) else f"@{os.path.basename(of[0])} {mark(of[1])}" for of in variation["vary"]]
    return {
        "text": mark(text.encode()),
        "files": {path: mark(contents) for path, contents in sorted(beside.items())},
        "choice": {"mechanism": mechanism, "set": set, "allow_redundant": allow_redundant},
        "asked": _given_options(request),
        "variants": {**_given_options(variation), "vary": vary},
    }


def _given_options(options: dict[str, Any]) -> dict[str, Any]:
    """Returns the options that are given; a number 0 is."""
    return {name: value for name, value in options.items() if value is not None and value is not False and value != []}


def _read_manifest(fs: pyarrow.fs.FileSystem, root: str) -> dict[str, Any] | None:
    """Reads the manifest of a folder, if there is one."""
    place = f"{root}/{WHOLE}"
    if fs.get_file_info(place).type == 0:
        return None
    with fs.open_input_stream(place) as stream:
        contents = stream.read()
    try:
        existing = json.loads(contents)
    except ValueError:
        existing = None
    if not isinstance(existing, dict) or not isinstance(existing.get("share"), int) or existing["share"] < 1:
        raise usage(f"the folder has a `{WHOLE}` that says nothing of a sweep", "name another folder")
    return existing


def _write_manifest(fs: pyarrow.fs.FileSystem, root: str, manifest: dict[str, Any], existing: dict[str, Any] | None) -> None:
    """Writes the manifest of a sweep; refuses a folder with another one."""
    place = f"{root}/{WHOLE}"
    if existing is not None:
        differ = list(_differing(existing, json.loads(json.dumps(manifest))))
        if differ:
            shown = "; ".join(differ[:MOST_DIFFERING]) + ("; …" if len(differ) > MOST_DIFFERING else "")
            raise usage(f"the folder holds another sweep: {shown}", "name another folder")
        return
    if any(name.startswith("part-") for name in _there(fs, root)):
        raise usage(f"the folder has shares and no `{WHOLE}` that says what of", "name another folder")
    beside = f"{root}/.{WHOLE}.{uuid.uuid4().hex}"
    with fs.open_output_stream(beside) as stream:
        stream.write(json.dumps(manifest, indent=1).encode())
    fs.move(beside, place)


#: Largest number of differences in a message.
MOST_DIFFERING = 4


def _differing(there: Any, here: Any, name: str = "") -> Iterator[str]:
    """Returns the differences between the manifest in the folder and the requested one, in words."""
    if there == here:
        return
    if isinstance(there, dict) and isinstance(here, dict):
        for key in [*here, *(key for key in there if key not in here)]:
            yield from _differing(there.get(key), here.get(key), key)
    elif isinstance(there, str) and isinstance(here, str) and there.startswith("sha256:"):
        yield f"`{name}` is another"
    else:
        texts = ["nothing" if value is None else json.dumps(value, ensure_ascii=False) for value in (there, here)]
        yield f"`{name}` is {texts[0]} there, and {texts[1]} here"


@contextlib.contextmanager
def _file_errors(folder: str) -> Iterator[None]:
    """Converts errors of a file system to :class:`mechc.FileError`."""
    try:
        yield
    except MechcError:
        raise
    except (OSError, ImportError) as error:
        why = (error.strerror if isinstance(error, OSError) else None) or str(error)
        data = {"file": folder, "errno": getattr(error, "errno", None)}
        raise FileError(*diagnostic_of("E0702", f"cannot write into `{folder}`: {why}", None, data)) from error


def _there(fs: pyarrow.fs.FileSystem, root: str) -> set[str]:
    from pyarrow.fs import FileSelector

    return {info.base_name for info in fs.get_file_info(FileSelector(root, allow_not_found=True))}


def _clear(fs: pyarrow.fs.FileSystem, root: str, made: list[tuple[int, int]]) -> None:
    """Removes temporary files of workers that died, if their shares exist now."""
    left = tuple(f".{_name(*of)}." for of in made)
    for name in _there(fs, root):
        if name.startswith(left):
            fs.delete_file(f"{root}/{name}")


def _opened(folder: str, filesystem: Any = None) -> tuple[pyarrow.fs.FileSystem, str]:
    """The file system of a folder, and its path there."""
    from pyarrow.fs import FileSystem

    if filesystem is not None:
        if not isinstance(filesystem, FileSystem):
            raise usage(f"`filesystem` is an object of {type(filesystem).__name__}", "one of `pyarrow.fs` is wanted")
        return filesystem, folder.rstrip("/")
    place = folder if "://" in folder else os.path.abspath(folder)
    try:
        with _file_errors(folder):
            fs, root = FileSystem.from_uri(place)
    except ValueError as error:
        # what it says of others than files
        raise usage(f"`out` is {folder!r}: {error}", "a folder, or a place that pyarrow opens as `s3://…` is wanted") from error
    return fs, root.rstrip("/")


def _name(first: int, last: int) -> str:
    return f"part-{first:012}-{last:012}.parquet"

