// Pages of made mechanisms: data in the form that `src/view/page` writes, and the HTML around them.

import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { encoded } from "./encode.mjs";
import { add, asin, atan2, cos, jet, mul, neg, sin, sqrt } from "./jets.mjs";

const dist = join(dirname(fileURLToPath(import.meta.url)), "..", "..", "dist");
const part = (name) => readFileSync(join(dist, name), "utf8");
const escaped = (text) => text.replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);

/** The page of some data, as a text. */
export function pageOf(data) {
    const parts = {
        title: escaped(data.name),
        version: escaped(data.mechc),
        // it asks nobody
        connect: "",
        docs: `<div class="docs"><p>${escaped(data.docs)}</p></div>`,
        style: part("page.css"),
        script: part("page.js"),
        notices: part("notices.txt").trim(),
        still: "",
        text: data.texts.map(({ text }) => `<pre class="plain">${escaped(text)}</pre>`).join(""),
        data: JSON.stringify(data).replace(/</g, "\\u003c"),
    };
    return part("page.html").replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]);
}

/** The table of bodies' poses and other columns, from functions that give jets at a time. */
export function motion(bodies, others, times, at) {
    const rows = Array.from(times, (time) => at(jet(time, 1)));
    const names = [...bodies.flatMap((body) => ["x", "y", "phi"].map((part) => `${body}.${part}`)), ...others.map(({ name }) => name)];
    const unit = (name) => others.find((other) => other.name === name) ?? { unit: name.endsWith(".phi") ? "rad" : "m" };
    const columns = [{ name: "t", unit: "s", kind: "time" }];
    const values = [Float64Array.from(times)];
    for (const [order, mark, per] of [["x", "", ""], ["d", ".d", "/s"], ["dd", ".dd", "/s^2"]]) {
        names.forEach((name, k) => {
            const { unit: text, scale } = unit(name);
            const kind = k < 3 * bodies.length ? "body" : others[k - 3 * bodies.length].kind ?? (order === "x" ? "measure" : "rate");
            columns.push({ name: name + mark, unit: text + per, ...(scale ? { scale } : {}), kind });
            values.push(Float64Array.from(rows, (row) => row[k][order]));
        });
    }
    return { columns, values };
}

export const grid = (from, to, rows) => Array.from({ length: rows }, (_, k) => (rows > 1 ? from + (k * (to - from)) / (rows - 1) : from));

/** The path with its y axis pointing down, which is how paths are written. */
const down = (d) => {
    let letter = "";
    let place = 0;
    return d.replace(/[A-Z]|-?[\d.]+(?:e-?\d+)?/g, (token) => {
        if (/[A-Z]/.test(token)) {
            [letter, place] = [token, 0];
            return token;
        }
        const isY = letter === "A" ? place % 7 === 6 : place % 2 === 1;
        const isSweep = letter === "A" && place % 7 === 4;
        place++;
        return String(isY ? -token : isSweep ? 1 - token : token);
    });
};

const bar = (length, half, from = 0) =>
    `M${from} ${-half}L${from + length} ${-half}A${half} ${half} 0 0 1 ${from + length} ${half}L${from} ${half}A${half} ${half} 0 0 1 ${from} ${-half}Z`;
const circle = (r) => `M${-r} 0A${r} ${r} 0 1 1 ${r} 0A${r} ${r} 0 1 1 ${-r} 0Z`;
const hatched = (at, r) =>
    [0, 1, 2, 3, 4].map((k) => `M${at + (-1.6 + 0.8 * k) * r} ${-2 * r}L${at + (-2.1 + 0.8 * k) * r} ${-2.7 * r}`).join("");

/** Collects declarations with their places in a text that grows. */
export class Sheet {
    text = "";
    declarations = [];

    line(text) {
        this.text += `${text}\n`;
        return this;
    }

    /** A line that declares something. */
    declare(name, kind, text) {
        const from = this.text.length + text.length - text.trimStart().length;
        this.line(text);
        this.declarations.push([name, kind, 0, from, this.text.length - 1]);
        return this.declarations.length - 1;
    }
}

const turned = (node) => ({ ...node, shapes: node.shapes.map(({ look, d }) => ({ look, d: down(d) })) });

export function whole(name, sheet, scene, table, more = {}) {
    const { columns, values } = table;
    const rows = values[0].length;
    const variant = { rows, data: rows > 0 ? encoded(values) : "", results: [], messages: [], edges: [], ...more.variant };
    const { variant: _, ...rest } = more;
    return {
        format: 1,
        mechc: "0.0.0",
        name,
        docs: "",
        texts: [{ name: `${name}.mech`, text: sheet.text }],
        scene: { declarations: sheet.declarations, traces: [], profiles: [], contacts: [], ...scene, nodes: scene.nodes.map(turned) },
        columns,
        vary: [],
        variants: [variant],
        ...rest,
    };
}

/** Where a four-bar stands: angles of the coupler and the rocker. */
function fourBarAngles(crank, [a, b, c, d]) {
    const [bx, by] = [mul(a, cos(crank)), mul(a, sin(crank))];
    const [dx, dy] = [add(d, neg(bx)), neg(by)];
    const square = add(mul(dx, dx), mul(dy, dy));
    const e = sqrt(square);
    // the angle at the crank's pin between the diagonal and the coupler
    const cosine = mul(add(square, b * b - c * c), { ...invert(mul(2 * b, e)) });
    const turn = add(Math.PI / 2, neg(asin(cosine)));
    const coupler = add(atan2(dy, dx), turn);
    const [px, py] = [add(bx, mul(b, cos(coupler))), add(by, mul(b, sin(coupler)))];
    return { bx, by, coupler, px, py, rocker: atan2(py, add(px, -d)) };
}

function invert(a) {
    return { x: 1 / a.x, d: -a.d / a.x ** 2, dd: -a.dd / a.x ** 2 + (2 * a.d * a.d) / a.x ** 3 };
}

/** A crank-rocker; `size` is the ground's length (m). */
export function fourBar({ rows = 1000, size = 0.4, names = {}, lengths = [0.1, 0.35, 0.3, 0.4], more = {}, speed = 2 * Math.PI } = {}) {
    const [a, b, c, d] = lengths.map((length) => (length * size) / 0.4);
    const name = { mechanism: "four_bar", crank: "crank", coupler: "coupler", rocker: "rocker", tip: "P", ...names };
    const sheet = new Sheet();
    sheet.line("/// A crank-rocker: the crank turns, the rocker swings.").line(`mechanism ${name.mechanism} {`);
    const ground = sheet.declare("ground", "ground", "    ground { point A = (0, 0); point B = (400 mm, 0) }");
    const crank = sheet.declare(name.crank, "body", `    body ${name.crank} { point A = (0, 0); point C = (100 mm, 0) }`);
    const coupler = sheet.declare(name.coupler, "body", `    body ${name.coupler} { point C = (0, 0); point D = (350 mm, 0); point ${name.tip} = (175 mm, 120 mm) }`);
    const rocker = sheet.declare(name.rocker, "body", `    body ${name.rocker} { point B = (0, 0); point D = (300 mm, 0) }`);
    const joints = ["main", "pin", "knee", "pivot"].map((joint) => sheet.declare(joint, "joint", `    joint ${joint}: revolute(…)  // a pin`));
    const motor = sheet.declare("motor", "driver", "    driver motor: rotation(main) = 60 rpm * t");
    const trace = sheet.declare("path", "trace", `    trace path = ${name.coupler}.${name.tip} in mm`);
    sheet.declare("lift", "measure", `    measure lift = y(${name.coupler}.${name.tip}) in mm`);
    sheet.line("}");
    const tip = [b / 2, (0.12 * size) / 0.4];
    const others = [
        { name: "path.x", unit: "mm", scale: [1, 1000, 1] },
        { name: "path.y", unit: "mm", scale: [1, 1000, 1] },
        { name: "lift", unit: "mm", scale: [1, 1000, 1] },
        { name: "swing", unit: "1" },
    ];
    const table = motion([name.crank, name.coupler, name.rocker], others, grid(0, 1, rows), (t) => {
        const phi = add(0.5, mul(speed, t));
        const { bx, by, coupler, rocker } = fourBarAngles(phi, [a, b, c, d]);
        const [cc, cs] = [cos(coupler), sin(coupler)];
        const [x, y] = [add(bx, mul(tip[0], cc), mul(-tip[1], cs)), add(by, mul(tip[0], cs), mul(tip[1], cc))];
        return [jet(0), jet(0), phi, bx, by, coupler, jet(d), jet(0), rocker, x, y, y, rocker];
    });
    const half = 0.022 * size;
    const points = [
        ["ground.A", ground, 0, [0, 0]],
        ["ground.B", ground, 0, [d, 0]],
        [`${name.crank}.A`, crank, 1, [0, 0]],
        [`${name.crank}.C`, crank, 1, [a, 0]],
        [`${name.coupler}.C`, coupler, 2, [0, 0]],
        [`${name.coupler}.D`, coupler, 2, [b, 0]],
        [`${name.coupler}.${name.tip}`, coupler, 2, tip, false],
        [`${name.rocker}.B`, rocker, 3, [0, 0]],
        [`${name.rocker}.D`, rocker, 3, [c, 0]],
    ].map(([name, body, frame, at, pin = true]) => {
        sheet.declarations.push([name, "point", ...sheet.declarations[body].slice(2)]);
        return { name, declaration: sheet.declarations.length - 1, frame, at, pin };
    });
    const plate = `M0 ${-half}L${b} ${-half}A${half} ${half} 0 0 1 ${b + 0.5 * half} ${0.86 * half}L${tip[0] + 0.5 * half} ${tip[1] + 0.86 * half}A${half} ${half} 0 0 1 ${tip[0] - 0.5 * half} ${tip[1] + 0.86 * half}L${-0.5 * half} ${0.86 * half}A${half} ${half} 0 0 1 0 ${-half}Z`;
    const support = (at, joint) => ({
        declaration: joint,
        fixed: 0,
        shapes: [
            { look: "support", d: `M${at} 0L${at - 1.6 * half} ${-2 * half}L${at + 1.6 * half} ${-2 * half}Z` },
            { look: "ground-line", d: `M${at - 2.2 * half} ${-2 * half}L${at + 2.2 * half} ${-2 * half}` },
            { look: "hatching", d: hatched(at, half) },
        ],
    });
    const pin = (declaration, anchor) => ({ declaration, upright: anchor, shapes: [{ look: "pin", d: circle(0.55 * half) }] });
    const nodes = [
        support(0, joints[0]),
        support(d, joints[3]),
        { declaration: rocker, fixed: 3, shapes: [{ look: "link", d: bar(c, half) }] },
        { declaration: coupler, fixed: 2, shapes: [{ look: "link", d: plate }] },
        { declaration: crank, fixed: 1, shapes: [{ look: "link", d: bar(a, half) }] },
        pin(joints[0], [0, 0, 0]),
        pin(joints[1], [1, a, 0]),
        pin(joints[2], [2, b, 0]),
        pin(joints[3], [0, d, 0]),
        { declaration: motor, upright: [0, 0, 0], shapes: [{ look: "arrow", d: `M${2 * half} 0A${2 * half} ${2 * half} 0 0 1 0 ${2 * half}` }] },
    ];
    const scene = {
        unit: half,
        extent: [[-1.2 * a, -1.4 * a], [1.1 * d, c + a]],
        frames: [ground, crank, coupler, rocker],
        points,
        nodes,
        traces: [{ declaration: trace, frame: 2, at: tip }],
    };
    return whole(name.mechanism, sheet, scene, table, { docs: "A crank-rocker: the crank turns, the rocker swings.", ...more });
}

/** Many bars, each a wheel of its own: as many bodies as one likes. */
export function many(bodies, rows = 121) {
    const sheet = new Sheet();
    const ground = sheet.declare("ground", "ground", "ground { }");
    const across = Math.ceil(Math.sqrt(bodies));
    const frames = [ground];
    const points = [];
    const nodes = [];
    const names = [];
    for (let k = 0; k < bodies; k++) {
        const name = `bar[${k}]`;
        names.push(name);
        const body = sheet.declare(name, "body", `body ${name} { point A = (0, 0); point B = (80 mm, 0) }`);
        frames.push(body);
        const [x, y] = [0.1 * (k % across), 0.1 * Math.floor(k / across)];
        points.push({ name: `${name}.A`, declaration: body, frame: k + 1, at: [0, 0], pin: true });
        points.push({ name: `${name}.B`, declaration: body, frame: k + 1, at: [0.04, 0], pin: true });
        nodes.push({ declaration: body, fixed: k + 1, shapes: [{ look: "link", d: bar(0.04, 0.006) }] });
        nodes.push({ declaration: body, upright: [0, x, y], shapes: [{ look: "pin", d: circle(0.004) }] });
        nodes.push({ declaration: body, upright: [k + 1, 0.04, 0], shapes: [{ look: "pin", d: circle(0.004) }] });
    }
    const table = motion(names, [], grid(0, 1, rows), (t) =>
        names.flatMap((_, k) => [jet(0.1 * (k % across)), jet(0.1 * Math.floor(k / across)), add(0.1 * k, mul((1 + (k % 7)) * 2 * Math.PI, t))]),
    );
    const side = 0.1 * across;
    return whole("many", sheet, { unit: 0.01, extent: [[-0.06, -0.06], [side, side]], frames, points, nodes }, table);
}
