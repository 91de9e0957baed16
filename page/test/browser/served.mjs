// `mechc view FILE` as a reader starts it: on a copy of a file in a folder of its own.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { browser } from "./browser.mjs";

export const MECHC = process.env.MECHC ?? "mechc";

/** A file with a text, and a server that follows it. */
export async function served(text, { name = "linkage.mech", options = [], beside = {} } = {}) {
    const folder = mkdtempSync(join(tmpdir(), "live-"));
    const path = join(folder, name);
    writeFileSync(path, text);
    for (const [name, text] of Object.entries(beside)) writeFileSync(join(folder, name), text);
    const process = spawn(MECHC, ["view", path, ...options], { stdio: ["ignore", "pipe", "pipe"] });
    const ended = new Promise((resolve) => process.on("exit", (code, signal) => resolve(code ?? signal)));
    let heard = "";
    const url = await new Promise((resolve, reject) => {
        process.stdout.on("data", (bytes) => {
            heard += bytes;
            if (heard.endsWith("\n")) resolve(heard.trim());
        });
        process.stderr.on("data", (bytes) => (heard += process.exitCode === null ? "" : bytes));
        process.on("exit", () => reject(new Error(`it ended: ${heard}`)));
    });
    return {
        path,
        folder,
        url,
        process,
        save: (text) => writeFileSync(path, text),
        replace: (text) => {
            writeFileSync(`${path}.new`, text);
            renameSync(`${path}.new`, path);
        },
        async end() {
            process.kill("SIGCONT");
            process.kill("SIGTERM");
            const code = await ended;
            rmSync(folder, { recursive: true });
            return code;
        },
    };
}

/** A page of a server, and what it did that it should not. */
export async function looked(url, options = {}) {
    const context = await (await browser()).newContext({ viewport: { width: 1280, height: 900 }, ...options });
    const page = await context.newPage();
    const faults = [];
    page.on("pageerror", (error) => faults.push(`error: ${error.stack}`));
    page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
    const { origin } = new URL(url);
    context.on("request", (request) => request.url().startsWith(`${origin}/`) || faults.push(`request: ${request.url()}`));
    await page.goto(url);
    await page.waitForFunction(() => window.mechc && document.querySelector(".time")?.textContent);
    await page.evaluate(() => mechc.pause());
    return { page, faults, close: () => context.close() };
}

/** A server and a page of it, which are ended whatever happens. */
export async function following(text, work, options) {
    const server = await served(text, options);
    try {
        const { page, faults, close } = await looked(server.url);
        await work({ server, page });
        assert.deepEqual(faults, []);
        await close();
    } finally {
        await server.end();
    }
}

/** Waits until something is so, as long as a machine may take that does much else, and says how long it took (ms). */
export async function until(page, work, argument) {
    const began = performance.now();
    await page.waitForFunction(work, argument, { polling: "raf", timeout: 60_000 });
    return performance.now() - began;
}

/** Presses a button that writes what is set into the file; says what the page says of that, once it has been answered. */
export async function written(page, button = "Write into the file") {
    await page.click(`.deeds >> text=${button}`);
    await page.waitForSelector(".deeds:not([aria-busy])", { state: "attached" });
    return page.textContent(".deeds .told");
}

/** The table that `mechc run` prints: the names, and the rows. */
export function table(path, options) {
    const text = execFileSync(MECHC, ["run", path, ...options], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"], maxBuffer: 1 << 28 });
    const [head, ...rows] = text.trim().split("\n").map((line) => line.split(","));
    return { columns: head, rows: rows.map((row) => row.map((cell) => (cell === "" ? NaN : Number(cell)))) };
}

/** A four-bar whose crank an input turns; its rocker's pivot is a point of the drawing. */
export const CRANK = `/// A crank that an input turns.
mechanism rocker {
    param rod = 90 mm
    param half = rod / 2
    param C = (100 mm, 0)
    input turn = 30 deg + 1 rev/s * t
    ground { point O = (0, 0)  point C = C }
    body crank at (0, 0, 30 deg) { point O = (0, 0)  point A = (30 mm, 0) }
    body coupler at (26 mm, 15 mm, 40 deg) { point A = (0, 0)  point B = (2 * half, 0) }
    body rocker at (100 mm, 0, 80 deg) { point C = (0, 0)  point B = (70 mm, 0) }
    joint main:  revolute(ground.O, crank.O)
    joint left:  revolute(crank.A, coupler.A)
    joint right: revolute(coupler.B, rocker.B)
    joint back:  revolute(ground.C, rocker.C)
    driver motor: rotation(main) = turn
    measure lift = y(coupler.B) in mm
    analysis from 0 s to 1 s every 10 ms
}
`;

/** The same with a ground so long that the crank cannot turn around. */
export const ROCKING = CRANK.replaceAll("100 mm", "150 mm").replace("1 rev/s", "10 deg/s");

const links = Array.from({ length: 6 }, (_, k) => `
    body coupler_${k} at (${26 + 100 * k} mm, 15 mm, 40 deg) { point A = (0, 0)  point B = (rod, 0) }
    body rocker_${k} at (${100 + 100 * k} mm, 0, 80 deg) { point C = (0, 0)  point B = (70 mm, 0) }
    body crank_${k + 1} at (${100 + 100 * k} mm, 0, 30 deg) { point O = (0, 0)  point A = (30 mm, 0) }
    joint left_${k}: revolute(crank_${k}.A, coupler_${k}.A)
    joint right_${k}: revolute(coupler_${k}.B, rocker_${k}.B)
    joint back_${k}: revolute(ground.C_${k}, rocker_${k}.C)
    joint next_${k}: revolute(ground.C_${k}, crank_${k + 1}.O)
    driver motor_${k + 1}: rotation(next_${k}) = 30 deg + 1 rev/s * t`);

/** Twenty bodies and a thousand rows: six four-bars, one behind the other, and a crank. */
export const ROW = `mechanism row {
    param rod = 90 mm
    ground { point O = (0, 0) ${links.map((_, k) => `point C_${k} = (${100 + 100 * k} mm, 0)`).join(" ")} }
    body crank_0 at (0, 0, 30 deg) { point O = (0, 0)  point A = (30 mm, 0) }
    body lid at (0, 0, 0) { point O = (0, 0)  point P = (10 mm, 0) }
    joint main: revolute(ground.O, crank_0.O)
    joint fast: weld(ground.O, lid.O)
    driver motor_0: rotation(main) = 30 deg + 1 rev/s * t${links.join("")}
    analysis from 0 s to 0.999 s every 1 ms
}
`;
