// The pages that `mechc view` writes of the examples. MECHC is the program; without it there is nothing to look at.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, readdirSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { close, opened } from "./browser.mjs";
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

test("there is a program to write pages", { skip: existsSync(mechc) ? false : `no ${mechc}` }, () => assert.ok(examples.length > 15));
