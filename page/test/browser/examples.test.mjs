// The pages that `mechc view` writes of the examples. MECHC is the program; without it there is nothing to look at.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, readdirSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { close, dataOf, opened } from "./browser.mjs";
import * as checks from "./checks.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..", "..");
const mechc = process.env.MECHC ?? join(root, "target", "debug", "mechc");
const folder = mkdtempSync(join(tmpdir(), "examples-"));
const examples = readdirSync(join(root, "examples")).filter((name) => name.endsWith(".mech"));

/** A page with more bodies than this may be larger. */
const MANY_BODIES = 20;
const SIZE = 300_000;

after(close);

function written(name, to) {
    const path = join(folder, to);
    execFileSync(mechc, ["view", join(root, "examples", name), "-o", path]);
    return path;
}

for (const name of existsSync(mechc) ? examples : []) {
    test(name, async () => {
        const path = written(name, name.replace(/mech$/, "html"));
        const again = written(name, `again-${name.replace(/mech$/, "html")}`);
        assert.ok(readFileSync(path).equals(readFileSync(again)), "the same input gives other bytes");
        const html = readFileSync(path, "utf8");
        assert.ok(!html.includes(root), "a path is in it");
        const bodies = JSON.parse(html.match(/id="mechc">([^]*?)<\/script>/)[1]).scene.frames.length - 1;
        const { size } = statSync(path);
        if (bodies <= MANY_BODIES) assert.ok(size <= SIZE, `${size} bytes`);
        else console.log(`# ${name}: ${bodies} bodies, ${size} bytes`);
        const shown = await opened(path);
        try {
            await checks.pinsAreWhereTheTableHasThem(shown, path);
            await checks.plotsShowTheirColumns(shown, path);
            await checks.playsAndScrubs(shown);
            await checks.keysDoWhatTheySay(shown, path);
            await checks.axeFindsNothing(shown);
            await checks.printsWhole(shown, path);
            assert.deepEqual(shown.faults, []);
        } finally {
            await shown.close();
        }
        const still = await opened(path, { moves: true, reducedMotion: "reduce", colorScheme: "dark" });
        await still.page.waitForTimeout(100);
        const first = await still.page.evaluate(() => [mechc.time, Number(document.querySelector(".scrub input").min)]);
        assert.equal(first[0], first[1], "it moves, although little motion was asked for");
        await checks.axeFindsNothing(still);
        assert.deepEqual(still.faults, []);
        await still.close();
        const without = await opened(path, { javaScriptEnabled: false });
        assert.ok((await without.page.locator(".still-picture").boundingBox()).height > 50, "there is no still");
        assert.match(await without.page.locator("body").innerText(), /does not run here/);
        await without.close();
    });
}

/** The rows that `mechc run` prints, as numbers. */
function rowsOf(name, ...set) {
    const text = execFileSync(mechc, ["run", join(root, "examples", name), "--format", "json", ...set], { encoding: "utf8" });
    return JSON.parse(text);
}

test("what varies is what `run --set` computes, to the bit", { skip: !existsSync(mechc) }, async () => {
    const path = join(folder, "varied.html");
    const name = "slider_crank.mech";
    const vary = ["--vary", "rod_length=110mm..190mm:9", "--vary", "crank_length=0.04m..50mm:3"];
    execFileSync(mechc, ["view", join(root, "examples", name), "-o", path, ...vary], { stdio: "ignore" });
    const data = dataOf(path);
    assert.equal(data.variants.length, 27);
    assert.deepEqual(data.vary.map(({ values, unit, nearest, own }) => [values.length, unit, nearest, own]), [[9, "mm", 4, null], [3, "m", 2, null]]);
    assert.deepEqual(data.vary[1].values, [0.04, 0.045, 0.05]);
    const shown = await opened(path);
    try {
        const place = () => shown.page.evaluate(() => document.querySelector(".mechanism").getScreenCTM().a);
        const size = await place();
        for (const [rod, crank, variant] of [[110, 0.04, 0], [150, 0.05, 14], [180, 0.045, 22]]) {
            await shown.page.evaluate(([rod, crank]) => mechc.set("rod_length", rod).then(() => mechc.set("crank_length", crank)), [rod, crank]);
            const { columns, rows } = rowsOf(name, "--set", `rod_length=${rod}mm`, "--set", `crank_length=${crank}m`);
            assert.deepEqual(data.columns.map((column) => column.name), columns);
            const table = await checks.tableOf(data, variant);
            assert.equal(table.rows, rows.length);
            const times = rows.map(([t]) => t);
            const told = await checks.rowsOf(shown.page, times);
            told.forEach((row, k) => row.forEach((value, c) => {
                assert.ok(Object.is(value, rows[k][c]), `${columns[c]} in row ${k}: ${value}, not ${rows[k][c]}`);
            }));
            await checks.pinsAreWhereTheTableHasThem(shown, path, variant);
            await checks.plotsShowTheirColumns(shown, path, variant);
            assert.equal(await place(), size, "the picture jumps");
        }
        const took = await shown.page.evaluate(async () => {
            const took = [];
            for (let k = 0; k < 60; k++) {
                const began = performance.now();
                await mechc.set("rod_length", 110 + 10 * ((k * 4) % 9));
                took.push(performance.now() - began);
            }
            return took.sort((a, b) => a - b)[57];
        });
        console.log(`# set: 95 % ${took.toFixed(1)} ms`);
        if (process.env.SPEED) assert.ok(took <= 33, `${took} ms`);
        await checks.axeFindsNothing(shown);
        await checks.printsWhole(shown, path);
        assert.deepEqual(shown.faults, []);
    } finally {
        await shown.close();
    }
});

test("variants that are not whole say why", { skip: !existsSync(mechc) }, async () => {
    const path = join(folder, "broken.html");
    const { stderr } = spawnSync(mechc, ["view", join(root, "examples", "slider_crank.mech"), "-o", path, "--vary", "rod_length=10mm..130mm:4"]);
    const shown = await opened(path);
    const said = (rod) => shown.page.evaluate((rod) => mechc.set("rod_length", rod).then(() => document.querySelector(".message")?.textContent), rod);
    try {
        assert.equal(await said(130), undefined);
        const size = Math.ceil(statSync(path).size / 1000);
        const told = await shown.page.locator(".variants p").textContent();
        assert.equal(told, `rod_length is 150 mm in the text. 4 variants, solved beforehand; this page has ${size} kB.`);
        assert.ok(stderr.toString().includes(`4 variants, ${size} kB`), "the terminal tells of another size");
        assert.match(await said(10), /error\[E0601\] the mechanism cannot be assembled/);
        assert.equal(await shown.page.locator(".time").textContent(), "no motion");
        assert.equal(await said(130), undefined);
        await checks.playsAndScrubs(shown);
        assert.deepEqual(shown.faults, []);
    } finally {
        await shown.close();
    }
});

test("there is a program to write pages", { skip: existsSync(mechc) ? false : `no ${mechc}` }, () => assert.ok(examples.length > 15));
