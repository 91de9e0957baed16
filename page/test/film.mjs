// The pictures of docs/live.md, made anew: node test/film.mjs, with MECHC and CHROMIUM as for the tests.

import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { close } from "./browser/browser.mjs";
import { CRANK, ROCKING, looked, served } from "./browser/served.mjs";

const out = fileURLToPath(new URL("../../docs/live/", import.meta.url));
const size = { viewport: { width: 1180, height: 800 }, colorScheme: "light" };
const shot = (page, name) => page.screenshot({ path: join(out, `${name}.png`) });

async function shown(text, work) {
    const server = await served(text);
    const { page, close } = await looked(server.url, size);
    await page.evaluate(() => mechc.seek(0.2));
    await work(page, server);
    await close();
    await server.end();
}

async function pin(page, name) {
    return (await page.evaluate(() => mechc.pins())).find(({ point }) => point === name);
}

/** Moves the pointer, pressed, through some places. */
async function dragged(page, places) {
    await page.mouse.move(...places[0]);
    await page.mouse.down();
    for (const place of places.slice(1)) {
        await page.mouse.move(...place);
        await page.waitForTimeout(30);
    }
    await page.waitForTimeout(400);
}

await shown(CRANK, async (page) => {
    await page.evaluate(() => mechc.set("rod", 110));
    await shot(page, "sliders");
});
await shown(ROCKING, async (page) => {
    await page.evaluate(() => mechc.seek(0));
    const [pivot, tip] = [await pin(page, "ground.O"), await pin(page, "crank.A")];
    const radius = Math.hypot(tip.x - pivot.x, tip.y - pivot.y);
    const at = (degrees) => [pivot.x + radius * Math.cos((degrees * Math.PI) / 180), pivot.y - radius * Math.sin((degrees * Math.PI) / 180)];
    await dragged(page, Array.from({ length: 20 }, (_, k) => at(30 + 5 * k)));
    await page.mouse.up();
    await shot(page, "dead_point");
});
await shown(CRANK, async (page) => {
    await page.evaluate(() => mechc.seek(0));
    const box = await page.locator('[data-handle="C"]').boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await dragged(page, Array.from({ length: 12 }, (_, k) => [x - 2 * k, y - 5 * k]));
    await page.mouse.up();
    await shot(page, "point");
});
await shown(CRANK, async (page, server) => {
    server.save(CRANK.replace("coupler.B, rocker.B", "coupler.B, rocker.Z"));
    await page.waitForSelector(".broken:not([hidden])");
    await shot(page, "wrong");
});
await close();
process.exit(0);
