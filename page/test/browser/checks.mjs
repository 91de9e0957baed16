// What must hold of every page.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { bundled } from "../made/bundled.mjs";
import { dataOf } from "./browser.mjs";

const { changed } = await bundled("data/changes.ts");
const { bytesOfBase64, columnsOf, inflated } = await bundled("data/inflate.ts");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/** The table of a page's variant, in SI. */
export async function tableOf(data, variant = 0) {
    const { rows, data: text } = data.variants[variant];
    const values = rows > 0 ? columnsOf(await inflated(bytesOfBase64(text)), rows, data.columns.length) : data.columns.map(() => []);
    return { rows, values, named: (name) => values[data.columns.findIndex((column) => column.name === name)] };
}

/** What comes of another size or of a moved pointer is drawn: that takes a frame, or two. */
export const drawn = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done)))));

/** The rows that a page has at some times. */
export async function rowsOf(page, times) {
    return page.evaluate(async (times) => {
        const rows = [];
        for (const time of times) {
            await mechc.seek(time);
            rows.push(mechc.row());
        }
        return rows;
    }, times);
}

/** Ten rows, evenly spread. */
export const tenRows = (rows) => [...new Set(Array.from({ length: 10 }, (_, k) => Math.round((k * (rows - 1)) / 9)))];

/** Where a place of a frame is in a row of the table. */
function placed(data, table, row, frame, [x, y]) {
    const name = data.scene.declarations[data.scene.frames[frame]][0];
    const [ox, oy, phi] = frame === 0 ? [0, 0, 0] : ["x", "y", "phi"].map((part) => table.named(`${name}.${part}`)[row]);
    return [ox + Math.cos(phi) * x - Math.sin(phi) * y, oy + Math.sin(phi) * x + Math.cos(phi) * y];
}

/** The scale and origin by which places become pixels, y running down; and how far the worst is from it (pixels). */
export function fitted(pairs) {
    const mean = (of) => pairs.reduce((sum, pair) => sum + of(pair), 0) / pairs.length;
    const [x, y, px, py] = [mean(({ at }) => at[0]), mean(({ at }) => at[1]), mean(({ pixel }) => pixel[0]), mean(({ pixel }) => pixel[1])];
    let [above, below] = [0, 0];
    for (const { at, pixel } of pairs) {
        above += (at[0] - x) * (pixel[0] - px) - (at[1] - y) * (pixel[1] - py);
        below += (at[0] - x) ** 2 + (at[1] - y) ** 2;
    }
    const scale = below > 1e-24 ? above / below : 1;
    const off = pairs.map(({ at, pixel }) => Math.hypot(px + scale * (at[0] - x) - pixel[0], py - scale * (at[1] - y) - pixel[1]));
    return { scale, worst: Math.max(0, ...off) };
}

/** Pins, as they are drawn, and bodies' frames, are where the table has them, at ten times. */
export async function pinsAreWhereTheTableHasThem({ page }, path, variant = 0) {
    const data = dataOf(path);
    data.scene = changed(data.scene, data.variants[variant].scene ?? {});
    const table = await tableOf(data, variant);
    const pairs = [];
    for (const row of tenRows(table.rows)) {
        const seen = await page.evaluate(async (time) => {
            await mechc.seek(time);
            const middle = (element) => {
                const { left, right, top, bottom } = element.getBoundingClientRect();
                return [(left + right) / 2, (top + bottom) / 2];
            };
            const drawn = [...document.querySelectorAll("[data-point]")].map((spot) => middle(spot.querySelector(".dot")));
            const bodies = [...document.querySelectorAll(".mechanism > [data-declaration]")].map((node) => {
                const { e, f } = node.getScreenCTM();
                return [e, f];
            });
            return { pins: mechc.pins(), drawn, bodies };
        }, table.values[0][row]);
        assert.equal(seen.pins.length, data.scene.points.length);
        data.scene.points.forEach(({ name, frame, at }, k) => {
            assert.equal(seen.pins[k].point, name);
            const pixel = [seen.pins[k].x, seen.pins[k].y];
            if (seen.drawn.length > 0) {
                const away = Math.hypot(seen.drawn[k][0] - pixel[0], seen.drawn[k][1] - pixel[1]);
                assert.ok(away < 0.5, `${name} is drawn ${away} px beside where pins() has it`);
            }
            pairs.push({ at: placed(data, table, row, frame, at), pixel });
        });
        if (seen.bodies.length > 0) {
            data.scene.nodes.forEach(({ fixed }, k) => {
                if (fixed !== undefined) pairs.push({ at: placed(data, table, row, fixed, [0, 0]), pixel: seen.bodies[k] });
            });
        }
    }
    const { scale, worst } = fitted(pairs);
    assert.ok(scale > 0, "the picture stands on its head");
    assert.ok(worst < 1, `something is ${worst} px from where the table has it`);
}

/** Every plot's mark is where the column says, and lies on a curve that is drawn; row() has the table's numbers. */
export async function plotsShowTheirColumns({ page }, path, variant = 0) {
    const data = dataOf(path);
    const table = await tableOf(data, variant);
    const times = tenRows(table.rows).map((row) => table.values[0][row]);
    for (const row of tenRows(table.rows)) {
        const shown = await page.evaluate(async (time) => {
            await mechc.seek(time);
            return mechc.row();
        }, table.values[0][row]);
        data.columns.forEach(({ name, scale: [a, b, c] = [1, 1, 1] }, k) => {
            const value = ((table.values[k][row] / a) * b) / c;
            assert.ok(Object.is(shown[k], value) || Number.isNaN(value), `${name}: ${shown[k]} is shown, ${value} is in the table`);
        });
    }
    const marks = await page.evaluate(async (times) => {
        const plots = [...document.querySelectorAll("figure[data-column]")];
        // a canvas that is read often is another one than the page's own
        const scratch = new OffscreenCanvas(7, 7).getContext("2d", { willReadFrequently: true });
        const marks = plots.map((plot) => ({ column: plot.getAttribute("data-column"), at: [] }));
        for (const time of times) {
            await mechc.seek(time);
            plots.forEach((plot, k) => {
                const dot = plot.querySelector(".now-dot").getBoundingClientRect();
                const canvas = plot.querySelector("canvas");
                const { left, top, width } = canvas.getBoundingClientRect();
                const pixels = canvas.width / width;
                const [x, y] = [((dot.left + dot.right) / 2 - left) * pixels, ((dot.top + dot.bottom) / 2 - top) * pixels];
                scratch.clearRect(0, 0, 7, 7);
                scratch.drawImage(canvas, 3 - Math.round(x), 3 - Math.round(y));
                const near = scratch.getImageData(0, 0, 7, 7).data;
                // the curve is blue: much more blue than red
                let drawn = false;
                for (let n = 0; n < near.length; n += 4) drawn ||= near[n + 3] > 100 && near[n + 2] - near[n] > 60;
                marks[k].at.push({ x, y, drawn });
            });
        }
        return marks;
    }, times);
    for (const { column, at } of marks) {
        const values = tenRows(table.rows).map((row) => table.named(column)?.[row]);
        if (values.some((value) => value === undefined)) continue;
        const known = at.map((mark, k) => ({ ...mark, value: values[k], time: times[k] })).filter(({ value }) => Number.isFinite(value));
        const spread = Math.max(...known.map(({ value }) => value)) - Math.min(...known.map(({ value }) => value));
        const size = Math.max(...known.map(({ value }) => Math.abs(value)));
        assert.ok(known.every(({ drawn }) => drawn), `${column}: no curve under the mark`);
        const line = (pairs) => {
            const mean = (k) => pairs.reduce((sum, pair) => sum + pair[k], 0) / pairs.length;
            const [u, v] = [mean(0), mean(1)];
            const slope = pairs.reduce((sum, [a, b]) => sum + (a - u) * (b - v), 0) / (pairs.reduce((sum, [a]) => sum + (a - u) ** 2, 0) || 1);
            return { slope, worst: Math.max(...pairs.map(([a, b]) => Math.abs(b - v - slope * (a - u)))) };
        };
        const across = line(known.map(({ time, x }) => [time, x]));
        assert.ok(across.slope > 0 && across.worst < 1, `${column}: time is ${across.worst} px away`);
        if (spread <= 1e-9 * size) continue;
        const up = line(known.map(({ value, y }) => [value / (spread || 1), y]));
        assert.ok(up.slope < 0 && up.worst < 1, `${column}: a value is ${up.worst} px away`);
    }
    return marks.length;
}

/** It plays, and the slider takes time. */
export async function playsAndScrubs({ page }) {
    const moved = await page.evaluate(async () => {
        await mechc.seek(-Infinity);
        const first = mechc.time;
        mechc.play();
        const late = performance.now() + 60_000;
        while (mechc.time === first && performance.now() < late) await new Promise(requestAnimationFrame);
        mechc.pause();
        return mechc.time - first;
    });
    assert.ok(moved > 0, "it does not play");
    const slider = page.locator(".scrub input");
    const { x, y, width, height } = await slider.boundingBox();
    await page.mouse.click(x + width / 2, y + height / 2);
    const share = await page.evaluate(() => {
        const slider = document.querySelector(".scrub input");
        return (mechc.time - Number(slider.min)) / (Number(slider.max) - Number(slider.min));
    });
    assert.ok(Math.abs(share - 0.5) < 0.05, `half way is ${share}`);
}

/** Nothing but keys: times, wishes, help. */
export async function keysDoWhatTheySay({ page }, path) {
    const { values: [times], rows } = await tableOf(dataOf(path));
    const time = () => page.evaluate(() => mechc.time);
    const press = (key) => page.keyboard.press(key);
    const at = async (row) => assert.equal(await time(), times[Math.max(0, Math.min(row, rows - 1))]);
    await page.evaluate(() => document.activeElement?.blur());
    await press("Home");
    await at(0);
    await press("ArrowRight");
    await at(1);
    await press("Shift+ArrowRight");
    await at(11);
    await press("ArrowLeft");
    await at(Math.min(11, rows - 1) - 1);
    await press("End");
    await at(rows - 1);
    await press("Home");
    await press("Space");
    await page.waitForFunction((first) => mechc.time > first, times[0]);
    await press("Space");
    assert.ok((await time()) > times[0], "Space does not play");
    const pressed = (name) => page.getByRole("button", { name, exact: true }).getAttribute("aria-pressed");
    for (const [key, name] of [["l", "Labels"], ["v", "Vectors"]]) {
        const before = await pressed(name);
        await press(key);
        assert.notEqual(await pressed(name), before, `${key} does not switch ${name}`);
    }
    const factor = () => page.locator(".factor").textContent();
    const before = await factor();
    await press("+");
    assert.notEqual(await factor(), before, "+ does not change the speed");
    await press("-");
    assert.equal(await factor(), before);
    await press("?");
    assert.ok(await page.locator("dialog").evaluate((dialog) => dialog.open), "? does not open the help");
    await press("Escape");
    assert.ok(!(await page.locator("dialog").evaluate((dialog) => dialog.open)));
    // everything that can be used can be reached
    const wanted = await page.evaluate(() => {
        const all = [...document.querySelectorAll("button, select, input, [tabindex='0']")];
        return all.filter((element) => element.checkVisibility() && element.tabIndex >= 0 && !element.disabled).length;
    });
    const met = new Set();
    for (let k = 0; k < wanted + 20; k++) {
        await press("Tab");
        met.add(await page.evaluate(() => (window.met ??= []).push(document.activeElement) && window.met.indexOf(document.activeElement)));
    }
    assert.ok(met.size >= wanted, `${met.size} of ${wanted} can be reached`);
}

/** axe-core finds nothing serious. */
export async function axeFindsNothing({ page }) {
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
    const grave = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
    const told = grave.map(({ id, nodes }) => `${id}: ${nodes.map(({ html, failureSummary }) => `${html.slice(0, 200)} ${failureSummary}`).join("; ")}`);
    assert.deepEqual(told, []);
}

/** On paper there are a picture, plots, text, and nothing is cut off. */
export async function printsWhole({ page }, path) {
    const pdf = await page.pdf({ format: "A4", margin: { top: "1cm", bottom: "1cm", left: "1cm", right: "1cm" } });
    assert.equal(pdf.subarray(0, 5).toString(), "%PDF-");
    await page.emulateMedia({ media: "print" });
    const paper = await page.evaluate(() => {
        const width = document.documentElement.clientWidth;
        const seen = (selector) => [...document.querySelectorAll(selector)].filter((element) => element.checkVisibility());
        const cut = seen("body *").filter((element) => element.getBoundingClientRect().right > width + 2 && !element.closest("svg"));
        return {
            plots: seen(".plotted .curve").map((curve) => curve.getAttribute("d").length),
            canvases: seen(".plot canvas").length,
            picture: seen(".picture .over, .picture canvas").map((element) => element.getBoundingClientRect().height),
            texts: seen(".text .source, .text .paper pre").map((element) => element.textContent),
            cut: cut.slice(0, 3).map((element) => `${element.tagName}.${element.className}`),
        };
    });
    await page.emulateMedia({ media: null });
    const data = dataOf(path);
    assert.deepEqual(paper.cut, []);
    assert.ok(paper.plots.every((length) => length > 10), "a plot is empty");
    assert.equal(paper.canvases, 0, "plots are printed as drawings");
    assert.ok(paper.picture.some((height) => height > 100), "there is no picture");
    assert.deepEqual(paper.texts, data.texts.map(({ text }) => text));
    return { pdf, plots: paper.plots.length };
}
