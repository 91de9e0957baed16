// A browser without a screen, and pages opened in it from files, as a reader opens them.

import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const FLAGS = ["--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const folder = mkdtempSync(join(tmpdir(), "page-"));
let files = 0;
let running;

export async function browser() {
    running ??= await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
    return running;
}

export async function close() {
    await running?.close();
    running = undefined;
}

/** A file with a text. */
export function file(text) {
    const path = join(folder, `${files++}.html`);
    writeFileSync(path, text);
    return path;
}

/** A page that stands still, and what it did that it should not: messages, errors, requests. */
export async function opened(path, { moves = false, ...options } = {}) {
    const context = await (await browser()).newContext({ viewport: { width: 1280, height: 800 }, ...options });
    const page = await context.newPage();
    const faults = [];
    page.on("console", (message) => faults.push(`${message.type()}: ${message.text()}`));
    page.on("pageerror", (error) => faults.push(`error: ${error.stack}`));
    page.on("dialog", (dialog) => faults.push(`dialog: ${dialog.message()}`));
    const url = pathToFileURL(path).href;
    context.on("request", (request) => request.url() === url || faults.push(`request: ${request.url()}`));
    await page.goto(url);
    if (options.javaScriptEnabled !== false) {
        await page.waitForFunction(() => window.mechc && document.querySelector(".time")?.textContent);
        if (!moves) await page.evaluate(() => mechc.pause());
    }
    return { page, faults, close: () => context.close() };
}

/** The data in a page. */
export function dataOf(path) {
    return JSON.parse(readFileSync(path, "utf8").match(/<script type="application\/json" id="mechc">([^]*?)<\/script>/)[1]);
}
