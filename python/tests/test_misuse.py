"""Nothing that a program does makes Python crash: it gets an error that says what is wrong, or an answer."""

from __future__ import annotations

import copy
import gc
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pyarrow as pa
import pytest
from conftest import ROOT

import mechc
from mechc import _mechc

#: What a machine that others use too takes to wake who waits (s).
SLACK = 0.15

ROBOT = ROOT / "examples/parallel_robot.mech"
CRANK = ROOT / "examples/slider_crank.mech"

#: What is no number, no text, or none that can be meant.
ODD = [
    None, True, b"180 mm", "", "   ", "nonsense", "0.18", "0.18 s", "1/0", "(", "\0", "𝔯𝔬𝔡", "9" * 400 + " m", float("nan"),
    float("inf"), -float("inf"), 1e308, -1e308, 5e-324, 10**400, -(10**400), 1j, object(), object, [], [0.01, 0.02], {}, {"a": 1}, (),
    set(), lambda: 1, np.nan, np.array([]), np.zeros(3), np.zeros((2, 2)), np.array("x"), np.array([object()], dtype=object),
    np.datetime64("2020-01-01"), np.float32(0.18), range(3), iter([1]), ..., NotImplemented, type, sys, Exception("no"),
]


class Broken:
    """Whatever is asked of it raises."""

    def __float__(self):
        raise RuntimeError("no float")

    def __index__(self):
        raise RuntimeError("no index")

    def __array__(self, *_, **__):
        raise RuntimeError("no array")

    def __fspath__(self):
        raise RuntimeError("no path")

    def __repr__(self):
        raise RuntimeError("no repr")

    def __iter__(self):
        raise RuntimeError("no iterator")

    def __len__(self):
        return -1


@pytest.fixture(scope="module")
def crank():
    return mechc.load(CRANK)


@pytest.fixture(scope="module")
def robot():
    return mechc.load(ROBOT)


def survives(call):
    """It answers or raises as Python does; nothing else comes."""
    try:
        call()
    except (mechc.MechcError, TypeError, ValueError, KeyError, OverflowError, RuntimeError, OSError, MemoryError, IndexError, AttributeError):
        pass


CALLS = {
    "load": lambda m, r, odd: mechc.load(odd),
    "parse": lambda m, r, odd: mechc.parse(odd),
    "parse files": lambda m, r, odd: mechc.parse(m.text, files={"a.mech": odd}),
    "mechanism": lambda m, r, odd: mechc.parse(m.text, mechanism=odd),
    "run param": lambda m, r, odd: m.run(rod_length=odd, columns="t"),
    "run set": lambda m, r, odd: m.run(set=odd, columns="t"),
    "run name": lambda m, r, odd: m.run(set={odd: 1.0}, columns="t"),
    "run input": lambda m, r, odd: r.run(inputs={"swing[0]": odd}, columns="t"),
    "run every": lambda m, r, odd: m.run(every=odd, columns="t") if odd not in (5e-324,) else None,
    "run at": lambda m, r, odd: m.run(at=odd, columns="t"),
    "run columns": lambda m, r, odd: m.run(columns=odd),
    "run by": lambda m, r, odd: m.run(by=odd, columns="t"),
    "run results": lambda m, r, odd: m.run(results=odd, columns="t"),
    "run tolerance": lambda m, r, odd: m.run(tolerance=odd, columns="t"),
    "run flag": lambda m, r, odd: m.run(reactions=odd, columns="t"),
    "run samples": lambda m, r, odd: r.run(samples=odd, columns="t"),
    "column": lambda m, r, odd: m.run()[odd],
    "at t": lambda m, r, odd: m.at(odd),
    "at input": lambda m, r, odd: r.at(inputs={"swing[0]": odd}),
    "at inputs": lambda m, r, odd: r.at(inputs=odd),
    "at rates": lambda m, r, odd: r.at(inputs={"swing[0]": 0.1}, rates={"swing[0]": odd}),
    "at by": lambda m, r, odd: r.at(by=odd),
    "at param": lambda m, r, odd: m.at(0.01, rod_length=odd),
    "vary": lambda m, r, odd: m.sweep(vary=odd),
    "vary values": lambda m, r, odd: m.sweep(vary={"rod_length": odd}, every="20 ms").read(),
    "between": lambda m, r, odd: m.sweep(vary={"rod_length": mechc.between(0.14, odd, 2)}, every="20 ms").read(),
    "variants": lambda m, r, odd: m.sweep(variants=odd),
    "samples": lambda m, r, odd: m.sweep(vary={"rod_length": mechc.between(0.14, 0.15)}, samples=odd, take=2, every="20 ms").read(),
    "jobs": lambda m, r, odd: m.sweep(vary={"rod_length": [0.14]}, jobs=odd, every="20 ms").read(),
    "skip": lambda m, r, odd: m.sweep(vary={"rod_length": [0.14]}, skip=odd, every="20 ms").read(),
    "until": lambda m, r, odd: m.sweep(vary={"rod_length": [0.14]}, until=odd, every="20 ms").read(),
    "progress": lambda m, r, odd: m.sweep(vary={"rod_length": [0.14]}, progress=odd, every="20 ms").read(),
    "jacobian": lambda m, r, odd: m.jacobian(odd, every="20 ms"),
    "objective": lambda m, r, odd: m.objective(odd, by=["rod_length"]),
    "residuals": lambda m, r, odd: m.residuals(["travel"], odd, by=["rod_length"], at=[0.0])([0.15]),
    "tolerance": lambda m, r, odd: m.tolerance({"rod_length": odd}, every="20 ms"),
    "to_rust": lambda m, r, odd: m.to_rust(lanes=odd),
    "raw": lambda m, r, odd: _mechc.Mechanism(odd, odd, odd, odd, odd, odd, odd),
    "raw run": lambda m, r, odd: m._run(odd),
    "raw sweep": lambda m, r, odd: m._sweep(odd, odd),
    "raw table": lambda m, r, odd: _mechc.Table(["a"], ["m"], [odd]),
    "raw at": lambda m, r, odd: _mechc._unpickle_at(["a"], ["m"], [[5], [], []], odd, None, ["ok"]),
}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", CALLS)
def test_odd_arguments(name, crank, robot):
    for odd in [*ODD, Broken()]:
        if name == "run every" and isinstance(odd, (int, float)) and not isinstance(odd, bool) and 0 < odd < 1e-6:
            continue
        survives(lambda: CALLS[name](crank, robot, odd))


#: Half of a pair of surrogates, which Python's texts may have and nothing else.
HALF = "a\ud800"

#: Where texts and names are taken.
TEXTS = {
    "text": lambda m, r, text: mechc.parse(m.text + "// " + text),
    "mechanism": lambda m, r, text: mechc.parse(m.text, mechanism=text),
    "files": lambda m, r, text: mechc.parse(m.text, files={"a.mech": text}),
    "text of set": lambda m, r, text: mechc.parse(m.text, set={"rod_length": text}),
    "name of set": lambda m, r, text: mechc.parse(m.text, set={text: 1.0}),
    "run set": lambda m, r, text: m.run(set={"rod_length": text}),
    "run set name": lambda m, r, text: m.run(set={text: 1.0}),
    "run keyword": lambda m, r, text: m.run(**{text: 1.0}),
    "run param": lambda m, r, text: m.run(rod_length=text),
    "run inputs": lambda m, r, text: r.run(inputs={"swing[0]": text}),
    "run from": lambda m, r, text: m.run(from_=text),
    "run at": lambda m, r, text: m.run(at=[0.0, text]),
    "run columns": lambda m, r, text: m.run(columns=["t", text]),
    "run results": lambda m, r, text: m.run(results=text),
    "run result": lambda m, r, text: m.run(results={"top": text}),
    "run result name": lambda m, r, text: m.run(results={text: "max(travel)"}),
    "run by": lambda m, r, text: m.run(by=text),
    "at set": lambda m, r, text: m.at(0.0, set={"rod_length": text}),
    "at inputs": lambda m, r, text: r.at(inputs={text: 1.0}),
    "at rates": lambda m, r, text: r.at(inputs={"swing[0]": 0.1}, rates={"swing[0]": text}),
    "at by": lambda m, r, text: m.at(0.0, by=[text]),
    "vary": lambda m, r, text: m.sweep({"rod_length": text}),
    "vary name": lambda m, r, text: m.sweep({text: [1.0]}),
    "vary list": lambda m, r, text: m.sweep({"rod_length": [text]}),
    "between": lambda m, r, text: m.sweep({"rod_length": mechc.between(text, 1.0, 3)}),
    "variants": lambda m, r, text: m.sweep(variants={text: [1.0]}),
    "until": lambda m, r, text: m.sweep({"rod_length": [0.14]}, until=text),
    "jacobian": lambda m, r, text: m.jacobian(text),
    "objective": lambda m, r, text: m.objective(text, by="rod_length"),
    "residuals": lambda m, r, text: m.residuals([text], [0.0], by="rod_length", at=[0.0]),
    "tolerance": lambda m, r, text: m.tolerance({"rod_length": (text, 0)}),
    "tolerance name": lambda m, r, text: m.tolerance({text: 1.0}),
}


@pytest.mark.parametrize("name", TEXTS)
def test_half_a_character_is_refused_in_words(name, crank, robot):
    with pytest.raises(mechc.UsageError, match=r"has '\\ud800' at character \d+, which is half a character") as caught:
        TEXTS[name](crank, robot, HALF)
    assert str(caught.value).isascii()
    # whole characters beyond those of sixteen bits are none of these
    try:
        TEXTS[name](crank, robot, "𝔯")
    except mechc.MechcError as error:
        assert "half a character" not in str(error)


PATHS = {
    "load": lambda m, r, path: mechc.load(path),
    "name": lambda m, r, path: mechc.parse(m.text, name=path),
    "files": lambda m, r, path: mechc.parse(m.text, files={path: ""}),
    "samples": lambda m, r, path: r.run(samples=path),
    "variants": lambda m, r, path: m.sweep(variants=path),
    "to_rust": lambda m, r, path: m.to_rust(path),
    "to_rust file": lambda m, r, path: m.to_rust(path + ".rs"),
    "to_latex": lambda m, r, path: m.to_latex(path),
    "to_json": lambda m, r, path: m.to_json(path),
    "view": lambda m, r, path: m.view(path + ".html"),
    "view folder": lambda m, r, path: m.view(path + "/a.svg"),
}


@pytest.mark.parametrize("name", PATHS)
def test_a_path_that_no_file_has_is_refused_in_words(name, crank, robot, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for path, why in ((HALF, "has half a character"), ("a\0b", "has a NUL in it")):
        with pytest.raises(mechc.UsageError, match=f"{why}, and no file is called so") as caught:
            PATHS[name](crank, robot, path)
        assert str(caught.value).isascii() and "\0" not in str(caught.value)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere names of files are texts")
def test_bytes_that_are_no_text_name_a_file(crank, tmp_path):
    path = os.fsencode(tmp_path) + b"/\xe9.mech"
    with open(path, "w") as file:
        file.write(crank.text)
    assert mechc.load(path).text == crank.text
    assert crank.to_latex(os.fsencode(tmp_path) + b"/\xe9.tex").exists()


def test_huge_questions_are_refused(crank):
    with pytest.raises((MemoryError, mechc.UsageError)):
        crank.run(every=1e-300)
    with pytest.raises((MemoryError, mechc.UsageError)):
        crank.run(to=1e9, every=1e-9)
    with pytest.raises((MemoryError, mechc.UsageError)):
        crank.at(np.broadcast_to(0.01, (1 << 20, 1 << 20)))
    sweep = crank.sweep(vary={"rod_length": mechc.between(0.1, 0.2)}, samples=10**12, yes=True)
    assert len(sweep) == 10**12


def test_deep_and_long_texts():
    for text in ("mechanism m { param a = " + "(" * 3000, "mechanism " * 300, "\0" * 300, "{" * 3000):
        with pytest.raises(mechc.InputError):
            mechc.parse(text)


def test_iterators_that_are_closed(crank):
    sweep = crank.sweep(vary={"rod_length": mechc.between("140 mm", "160 mm", 3000)}, results={"top": "max(travel)"})
    reader = pa.RecordBatchReader.from_stream(sweep)
    del reader
    for _ in range(3):
        reader = pa.RecordBatchReader.from_stream(sweep)
        reader.close()
    capsule = sweep.__arrow_c_stream__()
    del capsule
    gc.collect()
    stream = sweep.__arrow_c_stream__()
    del sweep
    gc.collect()
    del stream


def test_exceptions_in_callbacks(crank):
    sweep = crank.sweep(vary={"rod_length": [0.14, 0.15]}, results={"top": "max(travel)"}, progress=lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        sweep.read()
    with pytest.raises(Exception, match="division"):
        pa.table(sweep)


def test_pickle_of_everything(crank):
    run, sweep = crank.run(), crank.sweep(vary={"rod_length": [0.14, 0.15]}, results={"top": "max(travel)"})
    jacobian = crank.jacobian(["rod_length"], every="20 ms")
    everything = [crank, run, sweep, sweep.read(), crank.at(0.01), crank.at(np.array([0.0, 0.01])), jacobian, mechc.between(1, 2)]
    for one in everything:
        for again in (pickle.loads(pickle.dumps(one)), copy.copy(one), copy.deepcopy(one)):
            assert type(again) is type(one)
    again = pickle.loads(pickle.dumps(crank))
    assert again.run()["piston.x"].tobytes() == run["piston.x"].tobytes() == pickle.loads(pickle.dumps(run))["piston.x"].tobytes()
    assert pickle.loads(pickle.dumps(sweep)).read()["top"].tobytes() == sweep.read()["top"].tobytes()
    assert np.array_equal(pickle.loads(pickle.dumps(crank.at(0.01))).q, crank.at(0.01).q)
    try:
        crank.run(rod_length=0.048)
    except mechc.LockUp as error:
        again = pickle.loads(pickle.dumps(error))
        assert again.partial.rows == error.partial.rows and str(again) == str(error)
    else:
        pytest.fail("it does not lock up")
    f = crank.objective("peak", by=["rod_length"], results={"peak": "max(abs(der(der(travel))))"}, failed=np.inf)
    g = crank.residuals(["travel"], [0.0, 0.1], by=["rod_length"], at=[0.0, 0.01])
    for one in (f, g):
        for again in (pickle.loads(pickle.dumps(one)), copy.copy(one), copy.deepcopy(one)):
            assert type(again) is type(one) and again.by == one.by
            assert np.array_equal(np.hstack(again(one.x0 * 1.01)), np.hstack(one(one.x0 * 1.01)))
    assert pickle.loads(pickle.dumps(f)).value([0.01]) == np.inf
    for one in (_mechc.Table([], [], []), run._table, sweep._sweep):
        with pytest.raises(TypeError):
            pickle.dumps(one)


def test_eight_threads_over_one_mechanism(crank, robot):
    wanted = crank.run(rod_length=0.18)["piston.x"].tobytes(), robot.at(inputs={"swing[0]": 0.1}).q.tobytes()

    def work(k):
        run = crank.run(rod_length=0.18)["piston.x"].tobytes()
        swept = crank.sweep(vary={"rod_length": [0.14, 0.18]}, rows=True, columns=["piston.x"], jobs=1 + k % 2).read()
        assert swept["piston.x"][81:].tobytes() == crank.run(rod_length=0.18, lead=True)["piston.x"].tobytes()
        return run, robot.at(inputs={"swing[0]": 0.1}).q.tobytes()

    with ThreadPoolExecutor(8) as pool:
        assert set(pool.map(work, range(16))) == {wanted}


def test_no_lock_is_held_while_computing(crank):
    ticks, ended = [], threading.Event()

    def tick():
        while not ended.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.001)

    ticker = threading.Thread(target=tick)
    ticker.start()
    began = time.monotonic()
    crank.run(to=80.0, every="0.1 ms", columns="travel")
    took = time.monotonic() - began
    ended.set()
    ticker.join()
    gaps = np.diff([began, *[t for t in ticks if began <= t <= began + took], began + took])
    assert took > 0.05 and gaps.max() < took / 2


def run_python(code, **options):
    return subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=100, cwd=ROOT, **options)


@pytest.mark.parametrize(
    "work",
    [
        "m.run(to=1000, every=1e-4, columns='t')",
        "m.sweep(vary={'rod_length': mechc.between(0.1, 0.2)}, samples=10**7, results={'top': 'max(travel)'}).read()",
        "pa.table(m.sweep(vary={'rod_length': mechc.between(0.1, 0.2)}, samples=10**9, results={'top': 'max(travel)'}))",
        "pl.DataFrame(m.sweep(vary={'rod_length': mechc.between(0.1, 0.2)}, samples=10**9, results={'top': 'max(travel)'}))",
        "m.at(np.linspace(0, 0.04, 10**6))",
    ],
)
def test_ctrl_c(work):
    done = run_python(
        f"""
        import os, signal, threading, time
        import numpy as np, polars as pl, pyarrow as pa
        import mechc
        m = mechc.load("examples/slider_crank.mech")
        timer = threading.Timer(0.7, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        began = time.monotonic()
        try:
            try:
                {work}
            except Exception as why:
                # who reads a stream tells its own error, and the interruption is raised behind it
                assert "interrupted" in str(why)
                time.sleep(1)
        except KeyboardInterrupt:
            print("interrupted", time.monotonic() - began)
        m.run()
        print("goes on")
        """
    )
    assert "interrupted" in done.stdout and "goes on" in done.stdout, done.stdout + done.stderr
    assert float(done.stdout.split()[1]) < 30.0


#: So many links, each with two params: forty of them, and results that depend on all.
FORTY = """
    links = 20
    text = "mechanism chain { " + " ".join(f"param a{k} = 1 m param b{k} = {0.1 + 0.01 * k} rad" for k in range(links))
    text += " ground { point P = (0, 0) } "
    for k in range(links):
        text += f"body l{k} at ({k} m, 0, 0) {{ point A = (0, 0) point B = (a{k}, 0) }} "
        before = "ground.P" if k == 0 else f"l{k - 1}.B"
        text += f"joint j{k}: revolute({before}, l{k}.A) driver d{k}: rotation(j{k}) = b{k} * sin({k + 1} rad/s * t) "
    text += f"measure reach = x(l{links - 1}.B) result most = max(abs(der(der(reach)))) analysis from 0 s to 100 s every 1 ms }}"
    m = mechc.parse(text)
    by = [f"{of}{k}" for k in range(links) for of in "ab"]
"""


@pytest.mark.parametrize("pressed_after", [0.05, 0.3, 1.0])
@pytest.mark.parametrize("work", ["m.jacobian(by)", "m.objective('most', by)", "evaluated()"])
def test_ctrl_c_is_answered_at_once(work, pressed_after):
    """Whatever is under way, a proof or a motion: a tenth of a second, and what a busy machine takes to wake who waits."""
    done = run_python(
        f"""
import os, signal, threading, time
import numpy as np
import mechc
{textwrap.dedent(FORTY)}
def evaluated():
    while True:
        f(f.x0 * np.random.uniform(0.99, 1.01, len(by)))
if "evaluated" in {work!r}:
    f = m.objective('most', by, to=0.5, every=0.1)
pressed = []
def press():
    pressed.append(time.monotonic())
    os.kill(os.getpid(), signal.SIGINT)
threading.Timer({pressed_after}, press).start()
try:
    while True:
        {work}
except KeyboardInterrupt:
    print("answered", time.monotonic() - pressed[0])
print(m.at(0.0)["reach"])
"""
    )
    told = done.stdout.split()
    assert told and told[0] == "answered", done.stdout + done.stderr
    assert float(told[1]) < 0.1 + SLACK, told
    assert float(told[2]) == 20.0


@pytest.mark.skipif(not hasattr(os, "fork"), reason="it cannot fork")
def test_fork_in_the_middle_of_a_sweep():
    done = run_python(
        """
        import os, sys, warnings
        warnings.simplefilter("ignore")
        import pyarrow as pa
        import mechc
        m = mechc.load("examples/slider_crank.mech")
        m.at(0.01)
        sweep = m.sweep(vary={"rod_length": mechc.between(0.1, 0.2, 100)}, rows=True, columns=["travel"], jobs=2)
        whole = sweep.read()["travel"]
        told = []
        def progress(done, count):
            told.append(done)
            if len(told) == 1:
                global child
                child = os.fork()
        forked = m.sweep(vary={"rod_length": mechc.between(0.1, 0.2, 100)}, rows=True, columns=["travel"], jobs=2, progress=progress)
        found = forked.read()["travel"]
        assert found.tobytes() == whole.tobytes()
        assert m.at(0.01)["travel"] == m.run(at=[0.01])["travel"][0]
        if child == 0:
            sys.stdout.flush()
            os._exit(0)
        _, status = os.waitpid(child, 0)
        assert status == 0, status
        print("both are whole")
        """
    )
    assert "both are whole" in done.stdout, done.stdout + done.stderr


def test_a_signal_handler_that_raises():
    done = run_python(
        """
        import signal, os, threading
        import mechc
        class Enough(Exception): pass
        def handler(*_): raise Enough()
        signal.signal(signal.SIGUSR1, handler)
        m = mechc.load("examples/slider_crank.mech")
        threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGUSR1)).start()
        try:
            m.run(to=1000, every=1e-4, columns="t")
        except Enough:
            print("raised")
        """
    )
    assert "raised" in done.stdout, done.stdout + done.stderr


@pytest.mark.parametrize("which", range(4))
def test_the_end_of_the_interpreter(which):
    """While other threads compute."""
    done = run_python(
        """
        import threading, time
        import pyarrow as pa
        import mechc
        m = mechc.load("examples/slider_crank.mech")
        sweep = m.sweep(vary={"rod_length": mechc.between(0.1, 0.2)}, samples=10**7, results={"top": "max(travel)"})
        kept = pa.RecordBatchReader.from_stream(sweep)
        stream = sweep.__arrow_c_stream__()
        work = [sweep.read, lambda: pa.table(sweep), lambda: m.run(to=1000, every=1e-4, columns="t"), lambda: [m.at(0.01) for _ in range(10**7)]]
        for one in work[WHICH:WHICH + 1] * 2:
            threading.Thread(target=one, daemon=True).start()
        time.sleep(0.3)
        print("ends")
        """.replace("WHICH", str(which))
    )
    assert done.stdout.strip() == "ends" and done.returncode == 0, (done.returncode, done.stderr)
