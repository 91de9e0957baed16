// The stills and the film of docs/live.md, made anew: npm run film, with MECHC and CHROMIUM as for the tests. FRAMES names a folder for the
// film's frames, to look at each.

import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { close } from "../browser/browser.mjs";
import { CRANK, ROCKING, looked, served } from "../browser/served.mjs";
import { read, written } from "./png.mjs";
import { Film } from "./film.mjs";

const out = fileURLToPath(new URL("../../../docs/live/", import.meta.url));
const size = { viewport: { width: 1180, height: 800 }, colorScheme: "light" };
const shot = async (page, name) => writeFileSync(join(out, `${name}.png`), written([read(await page.screenshot())]));
/** A crank that rocks, and can be turned to a dead point. */
const FILMED = ROCKING.replace("10 deg/s * t", "40 deg * sin(1 rev/s * t)");
const wrong = (text) => text.replace("coupler.B, rocker.B", "coupler.B, rocker.Z");

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

/** Places around a pivot through which a hand takes a pin of a body, from an angle on by some steps (degrees). */
async function around(page, pivot, tip, [from, step, count]) {
    const [at, held] = [await pin(page, pivot), await pin(page, tip)];
    const radius = Math.hypot(held.x - at.x, held.y - at.y);
    return Array.from({ length: count }, (_, k) => ((from + step * k) * Math.PI) / 180).map((angle) => [at.x + radius * Math.cos(angle), at.y - radius * Math.sin(angle)]);
}

/** The middle of what a selector means. */
async function middle(page, selector) {
    const { x, y, width, height } = await page.locator(selector).first().boundingBox();
    return [x + width / 2, y + height / 2];
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
    await page.mouse.up();
}

await shown(CRANK, async (page) => {
    await page.evaluate(() => mechc.set("rod", 110));
    await shot(page, "sliders");
});
await shown(ROCKING, async (page) => {
    await page.evaluate(() => mechc.seek(0));
    await dragged(page, await around(page, "ground.O", "crank.A", [30, 5, 20]));
    await shot(page, "dead_point");
});
await shown(CRANK, async (page) => {
    await page.evaluate(() => mechc.seek(0));
    const [x, y] = await middle(page, '[data-handle="C"]');
    await dragged(page, Array.from({ length: 12 }, (_, k) => [x - 2 * k, y - 2 * k]));
    await shot(page, "point");
});
await shown(CRANK, async (page, server) => {
    server.save(wrong(CRANK));
    await page.waitForSelector(".broken:not([hidden])");
    await shot(page, "wrong");
});

await shown(FILMED, async (page, server) => {
    const film = await Film.of(page);
    const saved = () => readFileSync(server.path, "utf8");
    await page.evaluate(() => mechc.seek(0));

    await film.says("mechc view linkage.mech");
    for (let row = 0; row <= 100; row += 5) {
        await page.evaluate((time) => mechc.seek(time), row / 100);
        await film.frame();
    }

    await page.evaluate(() => mechc.seek(0));
    await film.says("A param has a slider");
    const [, level] = await middle(page, '[data-param="rod"]');
    const track = await page.locator('[data-param="rod"]').boundingBox();
    const along = (part) => [track.x + part * track.width, level];
    await film.drags([...Array(8).keys()].map((k) => along(0.5 - 0.016 * k)));
    await film.rests();

    await film.says("A point of the file is moved in the picture");
    const [x, y] = await middle(page, '[data-handle="C"]');
    await film.drags([...Array(9).keys()].map((k) => [x - 3 * k, y - 4 * k]));
    await film.rests();

    await film.says("A crank is turned by hand, up to its dead point");
    await film.drags(await around(page, "ground.O", "crank.A", [30, 6, 17]));
    await film.rests();

    await film.says("Time goes on");
    await film.clicks(".time-again");
    await film.says("What is not wanted goes: as in the file");
    await film.clicks("text=As in the file");
    await film.rests();

    await film.says("What is found goes into the file");
    await film.drags([...Array(6).keys()].map((k) => along(0.5 + 0.02 * k)));
    await film.clicks("text=Write into the file");
    await film.rests();

    await film.says("A save with a mistake: the picture stays, the message comes");
    const good = saved();
    server.save(wrong(good));
    await page.waitForSelector(".broken:not([hidden])");
    await film.rests();

    await film.says("Mended, it goes on where it was");
    server.save(good);
    await page.waitForSelector(".broken", { state: "hidden" });
    for (let row = 0; row <= 100; row += 5) {
        await page.evaluate((time) => mechc.seek(time), row / 100);
        await film.frame();
    }
    await film.rests();

    writeFileSync(join(out, "film.png"), written(film.frames));
    const { FRAMES } = process.env;
    if (FRAMES) {
        mkdirSync(FRAMES, { recursive: true });
        film.frames.forEach((frame, k) => writeFileSync(join(FRAMES, `${String(k).padStart(3, "0")}.png`), written([frame])));
    }
});
await close();
process.exit(0);
