// Pressure angles of the pages that `mechc view` writes, held against what `mechc run` measures.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { bundled } from "../made/bundled.mjs";
import { close, dataOf, opened } from "./browser.mjs";
import * as checks from "./checks.mjs";

const { pressure } = await bundled("motion/angles.ts");
const { Motion } = await bundled("motion/motion.ts");
const { Table } = await bundled("data/table.ts");

const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..", "..");
const mechc = process.env.MECHC ?? join(root, "target", "debug", "mechc");
const folder = mkdtempSync(join(tmpdir(), "cams-"));
const skip = existsSync(mechc) ? false : `no ${mechc}`;

after(close);

const SLIDES = `
    body follower at (0, 50 mm, 0) {
        circle wheel = (0, 0) radius 8 mm
        point  foot  = (0, 0)
        axis   face  = (0, 0) along (1, 0)
        axis   way   = (0, 0) along (0, 1)
        point  top   = (0, 60 mm)
    }
    joint guide: translational(ground.way, follower.way)`;
const SWINGS = `
    body follower at (60 mm, 40 mm, 175 deg) {
        circle wheel = (60 mm, 0) radius 8 mm
        point  foot  = (60 mm, 0)
        axis   face  = (0, 0) along (1, 0)
        point  pivot = (0, 0)
    }
    joint hinge: revolute(ground.B, follower.pivot)`;

const text = (follower, contact) => `/// A cam and what it moves.
mechanism pair {
    ground {
        point O  = (0, 0)
        point B  = (60 mm, 40 mm)
        axis way = O along (0, 1)
    }
    body disc {
        point O = (0, 0)
        circle rim = (6 mm, 0) radius 30 mm
        curve profile(v) = ((30 mm + 10 mm * (1 - cos(v))) * cos(v), (30 mm + 10 mm * (1 - cos(v))) * sin(v)) at 90 deg
    }${follower}
    joint axle: revolute(ground.O, disc.O)
    joint contact: ${contact}
    driver motor: rotation(axle) = 60 rpm * t + 20 deg
    measure pa = pressure_angle(contact, follower) in deg
    measure u = x(follower.${follower === SLIDES ? "top" : "foot"}) in mm
    analysis from 0 s to 0.7 s every 10 ms
}
`;

for (const [name, follower, contact] of [
    ["a roller that slides", SLIDES, "cam(disc.profile, follower.wheel)"],
    ["a roller, named first", SLIDES, "cam(follower.wheel, disc.rim)"],
    ["a roller that swings", SWINGS, "cam(disc.rim, follower.wheel)"],
    ["a tip", SLIDES, "point_follower(follower.foot, disc.profile)"],
    ["a tip that swings", SWINGS, "point_follower(follower.foot, disc.rim)"],
    ["a flat face that slides", SLIDES, "flat_follower(disc.rim, follower.face)"],
    ["a flat face that swings", SWINGS, "flat_follower(disc.rim, follower.face)"],
]) {
    test(`the pressure angle of ${name} is what is measured`, { skip }, async () => {
        const file = join(folder, `${name.replaceAll(/\W/g, "_")}.mech`);
        const path = file.replace(/mech$/, "html");
        writeFileSync(file, text(follower, contact));
        execFileSync(mechc, ["view", file, "-o", path]);
        const { columns, rows } = JSON.parse(execFileSync(mechc, ["run", file, "--format", "json"], { encoding: "utf8" }));
        const [time, measured] = ["t", "pa"].map((column) => columns.indexOf(column));
        const { page, faults, close: shut } = await opened(path);
        try {
            const plotted = await page.locator("figure[data-column]").evaluateAll((plots) => plots.map((plot) => plot.getAttribute("data-column")));
            assert.deepEqual(plotted, ["pa", "u"], "measures, and no joint's own coordinates");
            await page.getByRole("tab", { name: "Closer look" }).click();
            const entries = await page.getByLabel("at the joint").locator("option").allTextContents();
            assert.deepEqual(entries, ["–", "contact: disc moves follower"]);
            await page.getByLabel("at the joint").selectOption({ index: 1 });
            await page.getByRole("button", { name: "plot the pressure angle" }).click();
            const value = page.locator('figure[data-column="pressure angle"] .value');
            const data = dataOf(path);
            const table = await checks.tableOf(data);
            const motion = new Motion(data.scene, new Table(data.columns, table.values), []);
            for (const row of checks.tenRows(rows.length)) {
                const wanted = rows[row][measured];
                const angle = pressure(motion, motion.atRow(row, motion.moment()), data.scene.contacts[0]);
                await page.evaluate((time) => mechc.seek(time), rows[row][time]);
                if (wanted === null) {
                    assert.equal(angle, undefined);
                    continue;
                }
                const degrees = (angle * 180) / Math.PI;
                assert.ok(Math.abs(degrees - wanted) < 1e-6, `${degrees}°, not ${wanted}°, in row ${row}`);
                // what is shown has six digits
                const shown = await value.textContent();
                assert.ok(Math.abs(parseFloat(shown) - wanted) < 1e-4, `${shown}, not ${wanted}°, in row ${row}`);
            }
            assert.deepEqual(faults, []);
        } finally {
            await shut();
        }
    });
}
