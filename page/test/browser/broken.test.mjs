// The pages that `mechc view` writes of what is broken: refused, not to be assembled, stopped on its way.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { close, dataOf, opened } from "./browser.mjs";
import * as checks from "./checks.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..", "..");
const mechc = process.env.MECHC ?? join(root, "target", "debug", "mechc");
const folder = mkdtempSync(join(tmpdir(), "broken-"));
const skip = existsSync(mechc) ? false : `no ${mechc}`;

after(close);

/** A page of a mechanism that is broken, in both themes. */
function broken(name, code, look) {
    test(name, { skip }, async () => {
        const path = join(folder, basename(name).replace(/mech$/, "html"));
        const told = spawnSync(mechc, ["view", join(root, "tests", "ui", name), "-o", path, "--message-format", "short"]);
        assert.equal(told.status, code, told.stderr.toString());
        const headline = told.stderr.toString().match(/error\[\w+\]: (.*)/)[1];
        for (const colorScheme of ["light", "dark"]) {
            const shown = await opened(path, { colorScheme });
            const message = await shown.page.locator(".message.error").first().textContent();
            assert.ok(message.includes(headline), message);
            await look(shown, dataOf(path));
            await checks.axeFindsNothing(shown);
            await checks.printsWhole(shown, path);
            assert.deepEqual(shown.faults, []);
            await shown.close();
        }
    });
}

/** The declarations that are drawn as named by a message. */
async function wrong(page) {
    const names = await page.locator(".mechanism .wrong").evaluateAll((nodes) => nodes.map((node) => node.getAttribute("data-joint") ?? ""));
    return [...new Set(names)].sort();
}

/** All that is drawn is in the picture. */
async function isWhole(page) {
    const cut = await page.evaluate(() => {
        const frame = document.querySelector(".picture").getBoundingClientRect();
        const within = ({ left, right, top, bottom }) => left >= frame.left && right <= frame.right && top >= frame.top && bottom <= frame.bottom;
        return [...document.querySelectorAll(".mechanism path")].filter((path) => !within(path.getBoundingClientRect())).length;
    });
    assert.equal(cut, 0, "something is cut off");
}

broken("ndof/three_cranks_without_driver.mech", 1, async ({ page }) => {
    assert.equal(await page.locator(".look-free").count(), 4, "an arrow for each body that moves");
    assert.equal(await page.locator(".look-named-ring").count(), 1);
    assert.deepEqual(await wrong(page), ["b3"]);
    assert.equal(await page.locator(".declared.wrong").count(), 1);
    assert.equal(await page.locator(".time").textContent(), "no motion");
    await isWhole(page);
});

broken("run/loop_that_never_closes.mech", 3, async ({ page }, data) => {
    const ends = await page.locator(".look-gap-end").evaluateAll((rings) =>
        rings.map((ring) => {
            const { left, right } = ring.getBoundingClientRect();
            return (left + right) / 2;
        }),
    );
    assert.equal(ends.length, 2);
    const [low, high] = data.scene.extent;
    const { width } = await page.locator(".mechanism").boundingBox();
    // 8.88 mm of the extent, which is not much more than what is drawn
    const share = Math.abs(ends[0] - ends[1]) / width;
    assert.ok(share > 0.7 * (0.0084 / (high[0] - low[0])) && share < 0.0089 / (0.9 * (high[0] - low[0])), `${share}`);
    assert.equal(await page.locator(".look-gap").count(), 1);
    assert.ok((await wrong(page)).includes("swing"));
    await isWhole(page);
});

broken("run/four_bar_into_lock_up.mech", 3, async ({ page }, data) => {
    const mark = await page.locator(".mark.stop").boundingBox();
    const slider = await page.locator(".scrub input").boundingBox();
    assert.ok(mark.x > slider.x + 0.9 * slider.width && mark.x < slider.x + slider.width, "the mark is at the end");
    assert.match(await page.locator(".mark.stop").getAttribute("title"), /locks up/);
    assert.ok((await wrong(page)).includes("coupler"));
    const time = await page.evaluate(async () => {
        await mechc.seek(Infinity);
        return mechc.time;
    });
    assert.ok(time < data.variants[0].messages[0].time && time > 0.36, `${time}`);
    await isWhole(page);
});

test("where two branches meet the scrubber has a mark", { skip }, async () => {
    const path = join(folder, "passed.html");
    const name = join(root, "tests", "ui", "run", "parallelogram_through_its_change_point.mech");
    const told = spawnSync(mechc, ["view", name, "-o", path, "--pass-bifurcations", "--message-format", "short"]);
    assert.equal(told.status, 0, told.stderr.toString());
    const { page, faults, close: shut } = await opened(path);
    assert.ok((await page.locator(".mark.remark").count()) > 0);
    assert.match(await page.locator(".mark.remark").first().getAttribute("title"), /two branches/);
    assert.match(await page.locator(".message.warning").first().textContent(), /W0602/);
    assert.equal(await page.locator(".mechanism .wrong").count(), 0, "nothing is wrong");
    assert.deepEqual(faults, []);
    await shut();
});
