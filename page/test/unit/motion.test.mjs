// Between rows: polynomials through what both know. Places, velocities, accelerations of points; poles; angles; time.

import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "../made/bundled.mjs";
import { fourBar, motion as table, grid } from "../made/pages.mjs";
import { add, cos, jet, mul, sin } from "../made/jets.mjs";

const { between } = await bundled("motion/quintic.ts");
const { Motion, placeOf, velocityOf, accelerationOf, within } = await bundled("motion/motion.ts");
const { pole, polodes } = await bundled("motion/poles.ts");
const { transmission, pressure } = await bundled("motion/angles.ts");
const { Clock, told } = await bundled("motion/clock.ts");
const { inUnit, lengthUnit } = await bundled("data/lengths.ts");
const { measured, ticks } = await bundled("panes/series.ts");
const { Table, printed } = await bundled("data/table.ts");
const { bytesOfBase64, columnsOf, inflated } = await bundled("data/inflate.ts");
const { six, siUnit } = await bundled("numbers.ts");

const near = (a, b, by = 1e-9) => assert.ok(Math.abs(a - b) <= by * Math.max(1, Math.abs(b)), `${a} is not ${b}`);

/** Value and derivatives of a polynomial. */
const polynomial = (c, t) => [
    c.reduce((sum, a, k) => sum + a * t ** k, 0),
    c.reduce((sum, a, k) => sum + (k > 0 ? k * a * t ** (k - 1) : 0), 0),
    c.reduce((sum, a, k) => sum + (k > 1 ? k * (k - 1) * a * t ** (k - 2) : 0), 0),
];

for (const [smooth, degree, what] of [[3, 5, "quintic"], [1, 4, "quartic from the begin"], [2, 4, "quartic from the end"], [0, 3, "cubic"]]) {
    test(`a ${what} is met at every place`, () => {
        const c = [0.3, -1.2, 2, 0.7, -3, 1.5].slice(0, degree + 1);
        const [from, to] = [0.4, 1.7];
        const [begin, end] = [polynomial(c, from), polynomial(c, to)];
        const out = [0, 0, 0];
        for (const s of [0, 0.1, 0.5, 0.77, 1]) {
            // an acceleration that may not be used must not matter
            const [a0, a1] = [smooth & 1 ? begin[2] : 1e9, smooth & 2 ? end[2] : -1e9];
            between(out, s, to - from, begin[0], begin[1], a0, end[0], end[1], a1, smooth);
            polynomial(c, from + s * (to - from)).forEach((value, k) => near(out[k], value, 1e-10));
        }
    });
}

/** A motion of one body whose x is a function. */
function of(x, times, edges = []) {
    const { columns, values } = table(["b"], [], times, (t) => [x(t), jet(0), jet(0)]);
    const scene = { frames: [0, 1], declarations: [["ground", "ground", 0, 0, 0], ["b", "body", 0, 0, 0]], points: [], extent: [[0, 0], [1, 1]] };
    return new Motion(scene, new Table(columns, values), edges);
}

test("rows are met to the last bit", () => {
    const times = grid(0, 1, 11);
    const motion = of(sin, times);
    const moment = motion.moment();
    times.forEach((time, row) => {
        motion.at(time, moment);
        assert.equal(moment.row, row);
        assert.equal(moment.frames[9], Math.sin(time));
        assert.equal(moment.frames[12], Math.cos(time));
    });
});

test("between rows the quintic is near", () => {
    const motion = of(sin, grid(0, 1, 11));
    const moment = motion.at(0.537, motion.moment());
    near(moment.frames[9], Math.sin(0.537), 1e-10);
    near(moment.frames[12], Math.cos(0.537), 1e-8);
    near(moment.frames[15], -Math.sin(0.537), 1e-5);
});

test("it does not go across an edge", () => {
    // at rest until 0.25, then t² / 2: accelerations jump
    const x = ({ x: t }) => (t < 0.25 ? jet(0, 0, 0) : jet(0.5 * (t - 0.25) ** 2, t - 0.25, 1));
    const far = (edges) => {
        const motion = of(x, [0, 0.1, 0.2, 0.25, 0.3, 0.4], edges);
        return Math.max(...[0.21, 0.22, 0.24].map((t) => Math.abs(motion.at(t, motion.moment()).frames[9])));
    };
    assert.ok(far([]) > 1e-6, "the quintic sees the jump");
    assert.ok(far([0.25]) < 1e-15, "without the acceleration behind the edge it does not");
});

test("times before and behind are held at the ends", () => {
    const motion = of(sin, grid(0, 1, 11));
    assert.equal(motion.at(5, motion.moment()).frames[9], Math.sin(1));
    assert.equal(motion.at(-5, motion.moment()).frames[9], 0);
});

test("no row: everything as it is drawn", () => {
    const { columns } = table(["b"], [], [0], () => [jet(0), jet(0), jet(0)]);
    const motion = new Motion({ frames: [0, 1], declarations: [["ground"], ["b"]] }, new Table(columns, columns.map(() => new Float64Array(0))), [], [[0, 0, 0], [1, 2, 0.5]]);
    const moment = motion.at(0, motion.moment());
    assert.equal(moment.row, -1);
    assert.deepEqual([...moment.frames.slice(9, 12)], [1, 2, 0.5]);
});

const rows = 200;
const made = fourBar({ rows });
const unpacked = columnsOf(await inflated(bytesOfBase64(made.variants[0].data)), rows, made.columns.length);
const linkage = new Motion(made.scene, new Table(made.columns, unpacked), []);

test("points move as differences say", () => {
    const [h, t] = [1e-5, 0.3];
    const tip = [2, ...made.scene.points.find(({ name }) => name === "coupler.P").at];
    const at = (time) => placeOf(linkage.at(time, linkage.moment()), tip);
    const moment = linkage.at(t, linkage.moment());
    const [before, here, after] = [at(t - h), at(t), at(t + h)];
    for (const axis of [0, 1]) {
        near(velocityOf(moment, tip)[axis], (after[axis] - before[axis]) / (2 * h), 1e-6);
        near(accelerationOf(moment, tip)[axis], (after[axis] - 2 * here[axis] + before[axis]) / h ** 2, 1e-3);
    }
    const back = within(moment, 2, here);
    near(back[0], tip[1]);
    near(back[1], tip[2]);
});

test("a four-bar's poles: on its lines, and in line with each other", () => {
    for (const t of [0.05, 0.31, 0.62, 0.9]) {
        const moment = linkage.at(t, linkage.moment());
        const [p10, p12, p20, p30, p13] = [[1, 0], [1, 2], [2, 0], [3, 0], [1, 3]].map(([a, b]) => pole(moment, a, b));
        const pin = placeOf(moment, [1, 0.1, 0]);
        p10.forEach((part) => near(part, 0));
        p12.forEach((part, k) => near(part, pin[k], 1e-7));
        near(p30[0], 0.4);
        // Kennedy: the coupler's pole is in line with the crank, that of crank and rocker with the two bearings
        near(p20[0] * p12[1] - p20[1] * p12[0], 0, 1e-6 * Math.hypot(...p20));
        near(p13[1], 0, 1e-6 * Math.abs(p13[0]));
        // where it is, the coupler has no velocity
        const local = within(moment, 2, p20);
        near(Math.hypot(...velocityOf(moment, [2, ...local])), 0, 1e-6);
    }
    assert.equal(pole(linkage.at(0.1, linkage.moment()), 0, 0), undefined);
    const { one, other } = polodes(linkage, 2, 0);
    assert.equal(one.length, rows);
    assert.ok(other.filter(Boolean).length > 190);
});

test("a transmission angle is that of the triangle", () => {
    const moment = linkage.at(0, linkage.moment());
    const [a, b, c, d] = [0.1, 0.35, 0.3, 0.4];
    const square = a * a + d * d - 2 * a * d * Math.cos(0.5);
    const angle = Math.acos((b * b + c * c - square) / (2 * b * c));
    near(transmission(moment, [2, 0, 0], [2, b, 0], [3, 0, 0]), Math.min(angle, Math.PI - angle), 1e-9);
});

test("a cam's pressure angle is the slope of its law over its radius", () => {
    // a cam turns to the left, a centre above it goes up and down
    const { columns, values } = table(["cam", "follower"], [], grid(0, 1, 50), (t) => {
        return [jet(0), jet(0), mul(2, t), jet(0), add(0.05, mul(0.01, cos(mul(2, t)))), jet(0)];
    });
    const scene = { frames: [0, 1, 2], declarations: [["ground"], ["cam"], ["follower"]], points: [], extent: [[0, 0], [1, 1]] };
    const motion = new Motion(scene, new Table(columns, values), []);
    for (const t of [0.2, 0.5, 0.9]) {
        const angle = pressure(motion, motion.at(t, motion.moment()), { cam: 1, follower: 2, tip: [0, 0] });
        near(angle, Math.atan((0.01 * Math.sin(2 * t)) / (0.05 + 0.01 * Math.cos(2 * t))), 1e-6);
    }
});

test("a run lasts six seconds at first; it loops, or goes to and fro", () => {
    const clock = new Clock();
    clock.span(0, 0.04, true);
    assert.equal(told(clock.rate), "1/150 of real time");
    clock.advance(3);
    near(clock.time, 0.02);
    clock.advance(4.5);
    near(clock.time, 0.01);
    clock.turning = "to and fro";
    clock.advance(6);
    near(clock.time, 0.03);
    clock.advance(3);
    near(clock.time, 0.01);
    clock.span(0, 6, true);
    assert.equal(told(clock.rate), "real time");
    clock.faster();
    assert.equal(told(clock.rate), "2 × real time");
    clock.span(0, 0, true);
    clock.advance(1);
    assert.equal(clock.time, 0);
});

test("numbers have six digits, a decimal point and their unit", () => {
    assert.equal(six(12.3456789), "12.3457");
    assert.equal(six(-0.5), "\u22120.500000");
    assert.equal(six(0), "0");
    assert.equal(six(NaN), "–");
    assert.equal(six(1.5e-7), "1.50000e-7");
    assert.equal(siUnit("mm/s^2"), "m/s^2");
    assert.equal(siUnit("rpm/s"), "rad/s/s");
    assert.equal(printed({ name: "l", unit: "mm", scale: [1, 1000, 1] }, 0.05), 50);
});

test("time that a span has not comes back with one that has it", () => {
    const clock = new Clock();
    clock.span(0, 1, true);
    clock.go(0.3);
    clock.span(0, 0.1, false);
    assert.equal(clock.time, 0.1);
    clock.span(0, 1, false);
    assert.equal(clock.time, 0.3);
});

test("lengths are told in the unit that the text writes", () => {
    const unit = (...texts) => lengthUnit({ texts: texts.map((text) => ({ text })) }).name;
    assert.equal(unit("param a = 40 mm // 1 m 2 m 3 m\nparam b = 30mm, 1 m, 60 rpm"), "mm");
    assert.equal(unit("point A = (1 in, 2.5 in)", "1 mm"), "in");
    assert.equal(unit("a = 3 min, 4 mrad"), "m");
    near(inUnit(0.0254, { name: "in", times: 10000, by: 254 }), 1);
});

test("what is measured is told by what a column holds, not by its name", () => {
    const columns = [["t", "time"], ["b.x", "body"], ["roll.w", "joint"], ["u", "measure"], ["part.u", "measure"], ["u.d", "rate"]];
    assert.deepEqual(measured({ table: { columns: columns.map(([name, kind]) => ({ name, kind })) } }), ["u", "part.u"]);
});

test("an axis has three ticks at least, all of them on it", () => {
    for (const [least, greatest] of [[0, 1], [-0.06, 1.06], [99.5, 100.5], [-1e-6, 3.9e-6], [12, 49], [0.3, 0.61]]) {
        for (const about of [1, 2.5, 4, 8]) {
            const all = ticks(least, greatest, about);
            assert.ok(all.length >= 3 && all.length <= Math.max(10, 2 * about), `${all} from ${least} to ${greatest}`);
            assert.ok(all.every((tick) => tick >= least - 1e-9 * (greatest - least) && tick <= greatest + 1e-9 * (greatest - least)));
        }
    }
});
