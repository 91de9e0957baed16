"""One place, or many: the bits of the command, in whatever order and company."""

from __future__ import annotations

import copy
import itertools
import pickle
import time

import numpy as np
import pytest
from conftest import ROOT, command, numbers, same_bits

import mechc

EXAMPLES = ROOT / "examples"
ROBOT = EXAMPLES / "parallel_robot.mech"
FOUR_BAR = """mechanism four_bar {
    param crank_length = 40 mm
    param arm = 2.5 * crank_length
    input theta = 90 deg + 30 rpm * t
    ground { point O = (0, 0) point Q = (80 mm, 0) }
    body crank at (0, 0, 90 deg) { point O = (0, 0) point C = (crank_length, 0) }
    body coupler at (0, 40 mm, 36 deg) { point C = (0, 0) point D = (arm, 0) point pen = (2 * arm, 0) mass 1 kg at (arm, 0) }
    body rocker at (80 mm, 0, 91 deg) { point Q = (0, 0) point D = (arm, 0) }
    gravity (0, -9.81 m/s^2)
    joint main: revolute(ground.O, crank.O)
    joint pin: revolute(crank.C, coupler.C)
    joint knee: revolute(coupler.D, rocker.D)
    joint pivot: revolute(ground.Q, rocker.Q)
    driver motor: rotation(main) = theta
    measure pen_x = x(coupler.pen) in mm
    measure torque = effort(motor)
    analysis from 0 s to 2 s every 20 ms
}
"""


@pytest.fixture
def four_bar(tmp_path):
    path = tmp_path / "four_bar.mech"
    path.write_text(FOUR_BAR)
    return mechc.load(path), path


def held_against(found, table):
    for name, cells in table.items():
        wanted = numbers(cells)[-1]
        value = np.array([found[name]])
        assert same_bits(value, np.array([wanted])), (name, found[name], wanted)


@pytest.mark.filterwarnings("ignore::mechc.MechcWarning")
@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.mech")), ids=lambda path: path.stem)
def test_times_have_the_bits_of_the_command(path):
    m = mechc.load(path)
    if m.analysis is None:
        pytest.skip("it is a part")
    first, last, _ = m.analysis
    for part in (0.0, 0.37, 1.0):
        t = first + part * (last - first)
        ended = command("run", str(path), "--at", repr(t))
        found = m.at(t, strict=False)
        if ended.code:
            assert found.status != "ok"
        else:
            held_against(found, ended.table())


@pytest.mark.parametrize("theta", [0.3, -1.0, 1.5707963267948966, 4.0, 8.0])
def test_inputs_have_the_bits_of_the_command(four_bar, theta):
    m, path = four_bar
    ended = command("run", str(path), "--input", f"theta={theta} rad", "--from", "0", "--at", "0")
    assert ended.code == 0, ended.err
    held_against(m.at(theta=theta), ended.table())


def test_rates_have_the_bits_of_the_command(four_bar):
    m, path = four_bar
    formula = "theta=0.3 rad + 5 rad/s * (t - 0.5 s) + 0.5 * 2 rad/s^2 * (t - 0.5 s)^2"
    ended = command("run", str(path), "--input", formula, "--from", "0.5", "--at", "0.5", "--reactions")
    assert ended.code == 0, ended.err
    x = m.at(theta=0.3, t=0.5, rates={"theta": 5.0}, accelerations={"theta": "2 rad/s^2"}, reactions=True)
    held_against(x, ended.table())
    assert x["crank.phi.d"] == 5.0 and x["crank.phi.dd"] == 2.0 and x["motor.effort"] == x["torque"] != 0.0


def test_a_robot(tmp_path):
    m = mechc.load(ROBOT)
    given = {"swing[0]": 0.1, "swing[1]": -0.05, "swing[2]": 0.2}
    options = itertools.chain.from_iterable(("--input", f"{name}={value} rad") for name, value in given.items())
    ended = command("run", str(ROBOT), *options, "--from", "0", "--at", "0")
    assert ended.code == 0, ended.err
    held_against(m.at(inputs=given), ended.table())


def test_params_are_led_along_the_branch(four_bar):
    m, path = four_bar
    ended = command("run", str(path), "--lead", "--set", "crank_length=35 mm", "--at", "0.5")
    held_against(m.at(0.5, crank_length=0.035), ended.table())
    held_against(m.at("500 ms", crank_length="35 mm"), ended.table())


def test_neither_order_nor_company_change_a_bit(four_bar):
    m, _ = four_bar
    thetas = np.random.default_rng(3).uniform(-3, 9, 60)
    whole = m.at(theta=thetas)
    assert whole.q.shape == (60, 9) and whole["pen_x"].shape == (60,) and whole.status == ["ok"] * 60
    alone = np.array([m.at(theta=theta).q for theta in thetas])
    turned = m.at(theta=thetas[::-1].reshape(6, 10))
    assert turned.q.shape == (6, 10, 9) and turned.shape == (6, 10)
    assert np.array_equal(whole.q, alone) and np.array_equal(turned.q.reshape(60, 9)[::-1], alone)
    assert np.array_equal(whole.stacked(["pen_x", "torque"])[:, 0], whole["pen_x"])


def test_broadcasting(four_bar):
    m, _ = four_bar
    x = m.at(theta=np.linspace(0, 1, 3)[:, None], rates={"theta": np.array([1.0, 2.0])})
    assert x.shape == (3, 2) and np.array_equal(x["crank.phi.d"], [[1.0, 2.0]] * 3)
    with pytest.raises(mechc.UsageError, match="broadcasting"):
        m.at(theta=np.zeros(3), t=np.zeros(4))
    assert m.at(theta=[]).q.shape == (0, 9)


def test_derivatives_are_exact(four_bar):
    m, _ = four_bar
    x = m.at(theta=0.3, by=["theta", "crank_length"])
    for name, h in (("theta", 1e-6), ("crank_length", 1e-8)):
        value = 0.3 if name == "theta" else 0.04
        more, less = (m.at(**{"theta": 0.3, name: value + sign * h})["coupler.phi"] for sign in (1, -1))
        assert x[f"coupler.phi.by.{name}"] == pytest.approx((more - less) / (2 * h), rel=1e-6)


def test_what_does_not_get_there(four_bar):
    m, _ = four_bar
    x = m.at(0.5, arm=np.array([0.1, 0.09, 0.02]), strict=False)
    assert x.status[:2] == ["ok", "ok"] and x.status[2].startswith("E06")
    assert np.isnan(x.q[2]).all() and np.isfinite(x.q[:2]).all()
    with pytest.raises(mechc.AnalysisError) as caught:
        m.at(0.5, arm=np.array([0.1, 0.02]))
    assert caught.value.partial.status[0] == "ok"
    with pytest.raises(mechc.UsageError, match="was `theta` meant"):
        m.at(thta=1.0)
    with pytest.raises(mechc.UsageError, match="a length"):
        m.at(theta="3 mm")
    with pytest.raises(mechc.UsageError):
        m.at(theta=1.0, rates={"t": 1.0})
    with pytest.raises(mechc.UsageError):
        m.at(-1.0)
    with pytest.raises(KeyError):
        m.at(theta=1.0)["nothing"]


def test_a_formula_of_time_is_no_value(four_bar):
    m, _ = four_bar
    with pytest.raises(mechc.UsageError, match="`theta` is a formula of time"):
        m.at(t=[0.0, 0.1], theta="30 rpm*t")
    with pytest.raises(mechc.UsageError, match="formula of time"):
        m.at(theta=0.3, rates={"theta": "1 rad/s + 1 rad/s^2*t"})
    assert m.at(theta="30 deg")["crank.phi"] == pytest.approx(np.radians(30), abs=1e-15)


def test_odd_arrays_and_lists(four_bar):
    m, _ = four_bar
    with pytest.raises(mechc.UsageError, match="33 dimensions"):
        m.at(theta=np.zeros((1,) * 33))
    assert m.at(theta=np.zeros((1,) * 32)).q.shape == (1,) * 32 + (9,)
    assert same_bits(np.array([m.at(theta=0.3, by="theta")["crank.phi.by.theta"]]), np.array([1.0]))


@pytest.mark.parametrize("is_bent", [False, True])
@pytest.mark.parametrize("is_light", [False, True])
def test_lanes_have_the_bits_of_the_command(four_bar, is_bent, is_light):
    """Many angles, some of which no lane gets to: each is what the command has, and what it is alone."""
    m, path = four_bar
    if is_light:
        # what has no forces goes side by side
        kept = [line for line in FOUR_BAR.replace("mass 1 kg at (arm, 0)", "").splitlines() if "gravity" not in line and "torque" not in line]
        path.write_text("\n".join(kept))
        m = mechc.load(path)
    thetas = np.concatenate([np.linspace(-20, 20, 101), [0.0, -0.0, 1e-300, 1e3]])
    rates = np.linspace(-5, 5, len(thetas))
    bent = np.linspace(3, -3, len(thetas))
    accelerations = bent if is_bent else np.zeros(len(thetas))
    more = {"accelerations": {"theta": bent}, "reactions": True} if is_bent else {}
    whole = m.at(theta=thetas, rates={"theta": rates}, **more)
    assert whole.status == ["ok"] * len(thetas)
    for k in range(0, len(thetas), 8):
        theta, rate, acceleration = (repr(float(of[k])) for of in (thetas, rates, accelerations))
        formula = f"theta=({theta} rad) + ({rate} rad/s) * t" + (f" + 0.5 * ({acceleration} rad/s^2) * t^2" if is_bent else "")
        ended = command("run", str(path), "--input", formula, "--from", "0", "--at", "0", *(["--reactions"] if is_bent else []))
        assert ended.code == 0, ended.err
        for name, cells in ended.table().items():
            assert same_bits(whole[name][k : k + 1], cells[-1:]), (name, theta)


def test_lanes_and_places_alone_have_the_same_bits(four_bar):
    m, _ = four_bar
    random = np.random.default_rng(5)
    arms, thetas = random.uniform(0.09, 0.11, 40), random.uniform(-9, 9, 40)
    whole = m.at(theta=thetas, arm=arms, by=["theta", "arm"], strict=False)
    alone = [m.at(theta=theta, arm=arm, by=["theta", "arm"], strict=False) for theta, arm in zip(thetas, arms)]
    for name in whole:
        assert same_bits(whole[name], np.array([one[name] for one in alone])), name
    # a time of its own for each goes the careful way
    times = m.at(np.full(40, 0.0), theta=thetas)
    assert all(same_bits(times[name], m.at(theta=thetas)[name]) for name in times)


def test_no_way_leads_there_says_where_it_ends_and_which_element_it_is(four_bar):
    m, path = four_bar
    with pytest.raises(mechc.AnalysisError, match="on the way to the values that are set there is a dead point") as caught:
        m.at(0.5, arm=np.array([[0.1, 0.09, 0.02], [0.1, 0.1, 0.02]]))
    error = caught.value
    assert error.code == "E0612" and error.element == (0, 2)
    assert "it is element [0, 2] of those that are asked for" in str(error)
    labels = error.diagnostics[0]["labels"]
    line = next(k for k, text in enumerate(FOUR_BAR.splitlines(), 1) if "param arm" in text)
    assert labels[0]["start"]["line"] == line and "led from 0.1 m to 0.02 m, and got to 0.0" in labels[0]["text"]
    assert str(path) in str(error) and "estimates" not in str(error)
    with pytest.raises(mechc.AnalysisError, match="led from 0.1 m to 0.02 m") as caught:
        m.at(0.5, arm=0.02)
    assert caught.value.element is None and "element" not in str(caught.value)


def test_a_pickled_answer_keeps_why_it_is_not_there(four_bar):
    m, _ = four_bar
    x = m.at(0.5, arm=np.array([0.1, 0.02]), strict=False)
    for again in (pickle.loads(pickle.dumps(x)), copy.copy(x), copy.deepcopy(x)):
        assert str(again.error) == str(x.error) and again.error.diagnostics == x.error.diagnostics
        assert type(again.error) is type(x.error) and again.error.element == (1,) and again.status == x.status
    with pytest.raises(mechc.AnalysisError) as caught:
        m.at(0.5, arm=np.array([0.1, 0.02]))
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again.partial.error) == str(again) == str(caught.value)
    assert pickle.loads(pickle.dumps(m.at(0.5))).error is None


def test_elements_of_a_batch_go_side_by_side(four_bar):
    """They take a small part of what each takes alone on the careful way, on which a time of its own sends it."""
    _, path = four_bar
    kept = FOUR_BAR.replace("mass 1 kg at (arm, 0)", "").splitlines()
    path.write_text("\n".join(line for line in kept if "gravity" not in line and "torque" not in line))
    m, thetas = mechc.load(path), 1.5 + 1e-4 * np.arange(256)

    def took(ask):
        ask()
        began = time.process_time()
        ask()
        return time.process_time() - began

    times = np.linspace(1e-3, 2e-3, len(thetas))
    assert 5 * took(lambda: m.at(theta=thetas)) < took(lambda: m.at(times, theta=thetas))


def test_texts_are_read_as_a_run_reads_them(four_bar):
    m, _ = four_bar
    found = m.at(theta=["80 deg", "90 deg"], crank_length=["40 mm", "4 cm"])
    assert same_bits(found.q[1], m.at(theta="90 deg", crank_length=0.04).q) and found.shape == (2,)
    assert same_bits(m.at(theta="20 deg // a remark").q, m.at(theta="20 deg").q)
    for given in ({"crank_length": "20 deg"}, {"crank_length": "45"}, {"theta": "20 mm"}):
        with pytest.raises(mechc.UsageError) as at:
            m.at(**given)
        with pytest.raises(mechc.UsageError) as run:
            m.run(**given)
        messages = [of.value.diagnostics[0]["message"].partition(", found")[0] for of in (at, run)]
        assert messages[0] == messages[1] and at.value.code == run.value.code
        assert at.value.diagnostics[0]["labels"][0]["start"]["column"] == 1
    with pytest.raises(mechc.UsageError, match="the rate of `theta` must be"):
        m.at(theta=0.3, rates={"theta": "60 mm"})
    with pytest.raises(mechc.UsageError, match="expected an operator"):
        m.at(theta="0) + (1")


def test_set_takes_any_name():
    m = mechc.load(EXAMPLES / "walker.mech")
    copies = [name for name in m.params if name.startswith("left[") and name.endswith(".la")]
    assert len(copies) > 1
    wanted = m.at(t=0.1, set={name: "38.2 mm" for name in copies}).q
    assert same_bits(m.at(t=0.1, set={"left.la": "38.2 mm"}).q, wanted)
    spread = {name.replace("[", "[ ").replace("]", " ]"): "38.2 mm" for name in copies}
    assert same_bits(m.at(t=0.1, set=spread).q, wanted)
    drawn = mechc.parse("""mechanism drawn {
        param A = (80 mm, 0)
        ground { point O = A }
        body bar { point O = (0, 0) }
        joint main: revolute(ground.O, bar.O)
        input theta = t
        driver motor: rotation(main) = theta
    }""")
    assert drawn.at(theta=1.0, set={"A": "(9 cm, 1 mm)"}).q[:2].tolist() == [0.09, 0.001]
    with pytest.raises(mechc.UsageError, match="`A` is a point"):
        drawn.at(theta=1.0, set={"A": 0.1})
    with pytest.raises(mechc.UsageError):
        drawn.at(theta=1.0, set={"A": "(9 cm, 1 deg)"})
    for wrong in ({"set": {"theta": 1.0}}, {"inputs": {"A.x": 0.1}}, {"inputs": {"theta": 1.0}, "theta": 2.0}):
        with pytest.raises(mechc.UsageError):
            drawn.at(**wrong)


def test_keywords_whose_letters_python_writes_otherwise():
    m = mechc.parse("""mechanism letters {
        param \u00b5 = 80 mm
        ground { point O = (\u00b5, 0) }
        body bar { point O = (0, 0) }
        joint main: revolute(ground.O, bar.O)
        input \u03d1 = t
        driver motor: rotation(main) = \u03d1
        analysis from 0 s to 1 s every 1 s
    }""")
    # the parser of Python makes these of the letters above
    keywords = {"\u03bc": 0.09, "\u03b8": 0.5}
    assert m.at(**keywords).q.tolist() == [0.09, 0.0, 0.5]
    assert m.run(**keywords)["bar.x"].tolist() == [0.09, 0.09]


def test_before_the_first_time_there_is_nothing(four_bar):
    m, _ = four_bar
    with pytest.raises(mechc.UsageError, match="before the first time") as error:
        m.at(t=[0.1, -0.1])
    assert error.value.element == (1,) and "--" not in str(error.value)


def test_an_answer_is_a_mapping(four_bar):
    x = four_bar[0].at(theta=[0.3, 0.4])
    assert [name for name, _ in x.items()] == x.keys() and same_bits(x.values()[3], x[x.keys()[3]])
    assert x.get("nothing") is None and x.get("nothing", 3) == 3 and same_bits(x.get("pen_x"), x["pen_x"])
    with pytest.raises(KeyError, match="was `pen_x` meant"):
        x["penx"]
