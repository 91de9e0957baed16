// What a page looks like: in windows of any size and sharpness, in a lecture hall, under the pointer, while sliders move.

import assert from "node:assert/strict";
import { after, test } from "node:test";
import { fourBar, pageOf } from "../made/pages.mjs";
import { browser, close, file, opened } from "./browser.mjs";
import * as checks from "./checks.mjs";

after(close);

const usual = file(pageOf(fourBar({ rows: 200 })));

/** A four-bar whose coupler has several lengths; with one of them it cannot be assembled, and the page begins with it if it is asked to. */
function varied({ beginsBroken = false } = {}) {
    const lengths = [0.33, 0.34, 0.35, 0.36, 0.37];
    const all = lengths.map((length) => fourBar({ rows: 200, lengths: [0.1, length, 0.3, 0.4] }));
    const variants = all.map((page) => ({ ...page.variants[0], scene: [page.scene] }));
    const messages = [{ severity: "error", code: "E0601", text: "it cannot be assembled", notes: ["too short", "too long"], help: ["mend it"] }];
    const named = [all[0].scene.declarations.findIndex(([name]) => name === "pivot")];
    variants[0] = { ...variants[0], rows: 0, data: "", messages, named, drawn: [[0, 0, 0], [0, 0, 1], [0.1, 0.1, 0], [0.4, 0, 1]] };
    // a text that is longer than its pane
    const texts = [{ ...all[2].texts[0], text: all[2].texts[0].text + "\n".repeat(60) }];
    const vary = [{ name: "length", unit: "mm", values: lengths.map((length) => 1000 * length), nearest: beginsBroken ? 0 : 2, own: null }];
    return { ...all[2], texts, vary, variants, bytes: 123456 };
}

const box = (page, selector) => page.locator(selector).first().boundingBox();
const set = (page, length) => page.evaluate((length) => mechc.set("length", length), length);

test("what stands at the axes of plots is as sharp as the screen, also when that changes", async () => {
    const context = await (await browser()).newContext({ viewport: { width: 1280, height: 800 }, deviceScaleFactor: 2 });
    await context.addInitScript(() => {
        window.fonts = new Set();
        const { fillText } = CanvasRenderingContext2D.prototype;
        CanvasRenderingContext2D.prototype.fillText = function (...rest) {
            window.fonts.add(parseFloat(this.font));
            return fillText.apply(this, rest);
        };
    });
    const page = await context.newPage();
    await page.goto(`file://${usual}`);
    await page.waitForSelector(".plot canvas");
    const fonts = () => page.evaluate(() => [[...window.fonts], Math.round(parseFloat(getComputedStyle(document.querySelector(".area")).fontSize))]);
    const [sharp, size] = await fonts();
    assert.deepEqual(sharp, [2 * size]);
    const session = await context.newCDPSession(page);
    for (const ratio of [1.5, 1]) {
        await page.evaluate(() => window.fonts.clear());
        // here the browser tells of another ratio along with another size
        await session.send("Emulation.setDeviceMetricsOverride", { width: 1200 + 20 * ratio, height: 780, deviceScaleFactor: ratio, mobile: false });
        await page.waitForFunction((ratio) => devicePixelRatio === ratio && window.fonts.size > 0, ratio);
        assert.deepEqual((await fonts())[0], [Math.round(ratio * size)]);
    }
    await context.close();
});

test("a page that begins broken shows plots and goes as fast as any when it is whole; time is kept", async () => {
    const { page, faults, close: shut } = await opened(file(pageOf(varied({ beginsBroken: true }))));
    assert.equal(await page.locator(".plots .empty").textContent(), "There is no motion, and so there is nothing to plot.");
    await set(page, 350);
    assert.equal(await page.locator(".factor").textContent(), "1/6 of real time");
    assert.equal(await page.locator("figure canvas").count(), 4);
    assert.ok(!(await page.locator(".plots .empty").isVisible()));
    await page.evaluate(() => mechc.seek(0.3));
    for (const length of [330, 340]) await set(page, length);
    assert.equal(await page.evaluate(() => mechc.time), 0.3);
    assert.equal(await page.locator(".time").textContent(), "t = 0.300000 s");
    assert.deepEqual(faults, []);
    await shut();
});

test("what is said does not move the sliders; the line that it names is brought into sight", async () => {
    const { page, faults, close: shut } = await opened(file(pageOf(varied())));
    for (const [width, height] of [[1280, 800], [1000, 600], [800, 600], [390, 844]]) {
        await page.setViewportSize({ width, height });
        await set(page, 350);
        const before = await box(page, ".variants input");
        await set(page, 330);
        assert.deepEqual(await box(page, ".variants input"), before, `${width}×${height}`);
        assert.match(await page.locator(".message").textContent(), /cannot be assembled/);
    }
    await page.setViewportSize({ width: 1280, height: 420 + 200 });
    await set(page, 350);
    await page.locator(".text .sheet").evaluate((sheet) => sheet.scrollTo(0, sheet.scrollHeight));
    await set(page, 330);
    const [line, sheet] = [await box(page, ".declared.wrong"), await box(page, ".text .sheet")];
    assert.ok(line.y >= sheet.y && line.y + line.height <= sheet.y + sheet.height, "the line is out of sight");
    assert.equal(await page.locator(".variants p").textContent(), "5 variants, solved beforehand; this page has 124 kB.");
    assert.deepEqual(faults, []);
    await shut();
});

test("picture and sliders are seen together in a small window", async () => {
    const { page, close: shut } = await opened(file(pageOf(varied())), { viewport: { width: 800, height: 600 } });
    const [picture, slider] = [await box(page, ".picture"), await box(page, ".variants input")];
    assert.ok(picture.y >= 0 && picture.height > 200 && slider.y + slider.height <= 600, `${picture.height}, ${slider.y}`);
    await shut();
});

for (const colorScheme of ["light", "dark"]) {
    test(`what is pressed can be read under the pointer, ${colorScheme}`, async () => {
        const { page, close: shut } = await opened(usual, { colorScheme });
        const colours = (made) => made.evaluate((made) => [getComputedStyle(made).color, getComputedStyle(made).backgroundColor]);
        for (const made of [page.getByRole("button", { name: "Traces" }), page.locator(".play")]) {
            const before = await colours(made);
            await made.hover();
            assert.deepEqual(await colours(made), before);
            await checks.axeFindsNothing({ page });
        }
        const labels = page.getByRole("button", { name: "Labels" });
        const before = await colours(labels);
        await labels.hover();
        assert.notDeepEqual(await colours(labels), before, "what is not pressed answers the pointer");
        await shut();
    });
}

test("in a lecture hall the picture fills any window, and what is written in it grows", async () => {
    const { page, faults, close: shut } = await opened(file(pageOf(varied())));
    await page.keyboard.press("l");
    for (const [width, height] of [[800, 600], [1024, 768], [1280, 720], [1920, 1080], [390, 844]]) {
        await page.setViewportSize({ width, height });
        const size = async () => {
            const { width, height } = await box(page, ".picture");
            const [letters, line] = await page.evaluate(() => {
                const of = (selector, what) => parseFloat(getComputedStyle(document.querySelector(selector))[what]);
                return [of(".label", "fontSize"), of(".look-link", "strokeWidth")];
            });
            return { area: width * height, letters, line };
        };
        const before = await size();
        await page.getByRole("button", { name: "the picture alone" }).click();
        await checks.drawn(page);
        const after = await size();
        for (const what of ["area", "letters", "line"]) assert.ok(after[what] > 1.15 * before[what], `${what} at ${width}×${height}`);
        const [picture, slider, scrubber] = [await box(page, ".picture"), await box(page, ".variants input"), await box(page, ".scrub input")];
        assert.ok(picture.width * picture.height > 0.7 * width * height, `${picture.width} × ${picture.height} at ${width}×${height}`);
        assert.ok(slider.y + slider.height <= height && scrubber.y + scrubber.height <= height);
        const seen = await page.evaluate(() => [...document.querySelectorAll(".head, .beside, .results, .toolbar")].filter((part) => {
            const { left, top, width, height } = part.getBoundingClientRect();
            return width > 0 && part.contains(document.elementFromPoint(left + width / 2, top + height / 2));
        }).length);
        assert.equal(seen, 0, "something else is in sight");
        await checks.axeFindsNothing({ page });
        await page.keyboard.press("f");
        await checks.drawn(page);
        assert.deepEqual(await size(), before);
    }
    assert.deepEqual(faults, []);
    await shut();
});

test("lengths are told in the text's unit, and in SI beside it", async () => {
    const { page, close: shut } = await opened(usual);
    await page.evaluate(() => mechc.seek(0));
    await page.locator('[data-point="coupler.C"]').hover();
    assert.match(await page.locator(".note").textContent(), /x87\.7583 mmy47\.9426 mm\|v\|628\.319 mm\/s\|a\|3947\.84 mm\/s²/);
    await page.locator('[data-point="coupler.C"]').click();
    await page.getByRole("tab", { name: "Closer look" }).click();
    assert.equal(await page.locator(".facts dd").first().textContent(), "87.7583 mm");
    assert.equal(await page.locator(".facts dd").first().getAttribute("title"), "0.0877583 m (SI)");
    assert.match(await page.locator(".vectors .legend").first().textContent(), / mm\/s$/);
    await page.getByLabel("of this body").selectOption({ label: "rocker" });
    await page.getByLabel("and of that body").selectOption({ label: "ground" });
    const centre = page.locator(".closer output").first();
    assert.equal(await centre.textContent(), "x = 400.000 mm, y = 0 mm");
    assert.match(await centre.getAttribute("title"), /^x = 0\.400000 m/);
    await shut();
});

test("an angle at a pin is that of the variant that is shown", async () => {
    const { page, close: shut } = await opened(file(pageOf(varied())));
    await page.getByRole("tab", { name: "Closer look" }).click();
    await page.getByLabel("at the pin").selectOption({ label: "coupler.D = rocker.D" });
    await set(page, 370);
    await page.evaluate(() => mechc.seek(0));
    const [a, b, c, d] = [0.1, 0.37, 0.3, 0.4];
    const angle = (Math.acos((b * b + c * c - (a * a + d * d - 2 * a * d * Math.cos(0.5))) / (2 * b * c)) * 180) / Math.PI;
    const shown = parseFloat((await page.locator(".corners text").textContent()).slice(4));
    assert.ok(Math.abs(shown - Math.min(angle, 180 - angle)) < 0.006, `${shown}, not ${angle}`);
    await shut();
});

test("no label hides the driver's arrow; a trace lies above plates, and its marks are explained", async () => {
    const { page, faults, close: shut } = await opened(usual);
    await page.keyboard.press("l");
    for (const time of [0, 0.2, 0.4, 0.6, 0.8]) {
        const hidden = await page.evaluate(async (time) => {
            await mechc.seek(time);
            const arrow = document.querySelector(".look-arrow");
            const matrix = arrow.getScreenCTM();
            const places = Array.from({ length: 30 }, (_, k) => arrow.getPointAtLength((k / 29) * arrow.getTotalLength()).matrixTransform(matrix));
            const labels = [...document.querySelectorAll(".label:not(.hidden)")].map((label) => label.getBoundingClientRect());
            return labels.filter(({ left, right, top, bottom }) => places.some(({ x, y }) => left < x && x < right && top < y && y < bottom)).length;
        }, time);
        assert.equal(hidden, 0, `at ${time} s`);
    }
    const order = await page.evaluate(() => {
        const [traces, mechanism] = [".over .traces", ".over .mechanism"].map((selector) => document.querySelector(selector));
        return mechanism.compareDocumentPosition(traces) & Node.DOCUMENT_POSITION_FOLLOWING;
    });
    assert.ok(order, "the trace lies below");
    assert.match(await page.locator(".traces .legend").textContent(), /every 0\.1 s/);
    await page.keyboard.press("t");
    assert.equal(await page.locator(".traces .legend").count(), 0);
    assert.deepEqual(faults, []);
    await shut();
});

test("an acceleration that lies on a velocity is seen on it", async () => {
    const { page, close: shut } = await opened(usual);
    await page.keyboard.press("v");
    const arrows = await page.evaluate(() => [...document.querySelectorAll(".vectors path")].map((path) => [path.getAttribute("class"), parseFloat(getComputedStyle(path).strokeWidth)]));
    const [thick, thin] = ["velocity", "acceleration"].map((kind) => arrows.find(([name]) => name.endsWith(kind))[1]);
    assert.ok(thick > 2 * thin);
    const names = arrows.map(([name]) => name);
    assert.ok(names.indexOf("arrow-of-acceleration") > names.indexOf("arrow-of-velocity"), "the thin one lies above");
    await shut();
});

test("the help names a lecture's words, and where they are", async () => {
    const { page, close: shut } = await opened(usual);
    await page.keyboard.press("?");
    const text = await page.locator("dialog").textContent();
    for (const word of ["instant centre", "polodes", "transmission angle", "pressure angle", "Closer look"]) assert.ok(text.includes(word), word);
    await shut();
});
