// How fast a page that follows a text is: npm run speed, with MECHC and CHROMIUM as for the tests, on a machine that does nothing else.
// ROUNDS says how often each measurement is repeated; the least of its medians is what other work on the machine disturbed least.

import { browser, close } from "./browser/browser.mjs";
import { ROW, looked, served } from "./browser/served.mjs";
import { session } from "./browser/session.mjs";
import { sliderToPicture } from "./browser/speed.mjs";

const ROUNDS = Number(process.env.ROUNDS ?? 5);
/** Keystrokes, or moves of a slider, of a measurement. */
const TIMES = 100;
/** From one keystroke to the next (ms). */
const PAUSE = 100;

const wait = (time) => new Promise((resolve) => setTimeout(resolve, time));

/** The least median of some measurements, and the least of what 95 of 100 keep (ms). */
async function told(what, measured) {
    const all = [];
    for (let round = 0; round < ROUNDS; round++) all.push(await measured());
    const least = (of) => Math.min(...all.map(of)).toFixed(1).padStart(7);
    console.log(`${what.padEnd(52)} ${least(({ median }) => median)} ${least(({ most }) => most)}`);
}

async function sliders() {
    const server = await served(ROW);
    const { page, close } = await looked(server.url);
    await told("slider to picture", () => sliderToPicture(page, { param: "rod", from: 80, to: 100, point: "rocker_0.B" }, TIMES));
    await close();
    await server.end();
}

/** From a keystroke until it is known what is wrong: of a digit that is typed into a number and taken back. */
async function typed(editor) {
    const line = ROW.split("\n").findIndex((line) => line.includes("param rod = 90 mm"));
    const at = ROW.split("\n")[line].indexOf("90") + 2;
    const times = [];
    for (let k = 0; k < TIMES; k++) {
        await wait(PAUSE);
        const began = performance.now();
        await (k % 2 ? editor.type(line, [at, at + 1], "") : editor.type(line, [at, at], "."));
        times.push(performance.now() - began);
    }
    times.sort((a, b) => a - b);
    return { median: times[TIMES >> 1], most: times[Math.floor(0.95 * TIMES)] };
}

async function keystrokes() {
    const alone = await session(ROW);
    await told("keystroke to diagnostics", () => typed(alone));
    await alone.end();
    const editor = await session(ROW);
    const { url } = await editor.request("mechc/view");
    const context = await (await browser()).newContext();
    const page = await context.newPage();
    await page.goto(url);
    await page.waitForFunction(() => document.querySelector(".time")?.textContent);
    await page.evaluate(() => mechc.play());
    await told("keystroke to diagnostics, while a page of it plays", () => typed(editor));
    await context.close();
    await editor.end();
}

console.log(`${"milliseconds".padEnd(52)}  median    95 %`);
await sliders();
await keystrokes();
await close();
process.exit(0);
