// Pages of one server together, and what comes between a page and its server.

import assert from "node:assert/strict";
import { after, test } from "node:test";
import { browser, close } from "./browser.mjs";
import { CRANK, following, looked, served, until } from "./served.mjs";

after(close);

const shows = (text) => document.querySelector(".source")?.textContent.includes(text);

/** Holds what the program tells without being asked, as long as `held` is set: a page that is told late. */
function holdNews() {
    const { fetch } = globalThis;
    globalThis.fetch = async (...asked) => {
        const response = await fetch(...asked);
        if (!String(asked[0]).includes("/events")) return response;
        const late = new TransformStream({
            async transform(chunk, controller) {
                while (globalThis.held) await new Promise((resolve) => setTimeout(resolve, 10));
                controller.enqueue(chunk);
            },
        });
        return new Response(response.body.pipeThrough(late), { status: response.status });
    };
}

test("a save that a moved input hears of before the news is shown", async () => {
    const server = await served(CRANK);
    const context = await (await browser()).newContext();
    const page = await context.newPage();
    await page.addInitScript(holdNews);
    await page.goto(server.url);
    await page.waitForFunction(() => document.querySelector(".time")?.textContent);
    await page.evaluate(() => mechc.seek(0.2).then(() => mechc.pause()).then(() => mechc.set("turn", 1)));
    await page.evaluate(() => (globalThis.held = true));
    const first = await version(page);
    server.save(CRANK.replace("90 mm", "91 mm"));
    while ((await version(page)) === first) await page.waitForTimeout(20);
    await page.evaluate(() => mechc.set("turn", 1.1));
    await page.evaluate(() => (globalThis.held = false));
    await until(page, shows, "rod = 91 mm");
    assert.ok(await page.isVisible(".time-again"), "the input is still moved");
    await context.close();
    await server.end();
});

/** The version that the program has, asked beside the page. */
async function version(page) {
    return page.evaluate(async () => {
        const headers = { "X-Mechc-Token": location.hash.slice(1) };
        const response = await fetch("/motion", { method: "POST", headers, body: JSON.stringify({ page: "beside" }) });
        const bytes = await response.arrayBuffer();
        return JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, new DataView(bytes).getUint32(0, true)))).live.version;
    });
}

test("eight tabs of one browser follow the file, whichever of them are closed", async () => {
    const server = await served(CRANK);
    const context = await (await browser()).newContext();
    const tabs = [];
    for (let k = 0; k < 8; k++) {
        const tab = await context.newPage();
        await tab.goto(server.url);
        await until(tab, () => document.querySelector(".time")?.textContent);
        tabs.push(tab);
    }
    const all = (text) => Promise.all(tabs.map((tab) => tab.waitForFunction(shows, text, { polling: 50, timeout: 60_000 })));
    server.save(CRANK.replace("90 mm", "91 mm"));
    await all("rod = 91 mm");
    for (const gone of [0, 3]) {
        await tabs.splice(gone, 1)[0].close();
        server.save(CRANK.replace("90 mm", `9${gone + 2} mm`));
        await all(`rod = 9${gone + 2} mm`);
    }
    await tabs.splice(0, 1)[0].reload();
    await server.end();
    await Promise.all(tabs.map((tab) => tab.waitForSelector(".away:not([hidden])")));
    await context.close();
});

test("a new address in the same tab is followed", async () => {
    const first = await served(CRANK);
    const { page, close } = await looked(first.url);
    const { port, origin } = new URL(first.url);
    await first.end();
    await page.waitForSelector(".away:not([hidden])");
    const second = await served(CRANK.replace("90 mm", "93 mm"), { options: ["--port", port] });
    assert.equal(new URL(second.url).origin, origin);
    await page.evaluate((hash) => (location.hash = hash), new URL(second.url).hash);
    await until(page, shows, "rod = 93 mm");
    assert.ok(await page.isHidden(".away"));
    await close();
    await second.end();
});

test("a page says that it works, where that takes time", async () => {
    await following(CRANK, async ({ server, page }) => {
        // a program that gets no time, as beside other work
        server.process.kill("SIGSTOP");
        await page.evaluate(() => void mechc.set("rod", 91));
        await page.waitForSelector(".working:not([hidden])", { timeout: 60_000 });
        server.process.kill("SIGCONT");
        await page.waitForSelector(".working", { state: "hidden", timeout: 60_000 });
    });
});
