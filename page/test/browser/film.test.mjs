// What the film of docs/live.md is written with: browsers read from it what was put in.

import assert from "node:assert/strict";
import { after, test } from "node:test";
import { read, written } from "../film/png.mjs";
import { browser, close } from "./browser.mjs";

after(close);

const [width, height] = [40, 30];

/** A square on a ground, and a row of more colours than a palette holds where they are asked for. */
function frame(at, { colours = 0, shown = 100 } = {}) {
    const pixels = new Uint32Array(width * height).fill(0xf3f5f8);
    for (let y = 5; y < 15; y++) pixels.fill(0x0a5aa8, y * width + at, y * width + at + 10);
    for (let k = 0; k < colours; k++) pixels[600 + k] = ((k % 100) << 16) | (k % 3);
    return { width, height, pixels, shown };
}

/** The frames of a file, as a browser shows them. */
async function decoded(bytes) {
    const page = await (await (await browser()).newContext()).newPage();
    // what decodes is there for pages of this machine alone
    await page.route("http://127.0.0.1:9/", (route) => route.fulfill({ contentType: "text/html", body: "<!doctype html>" }));
    await page.goto("http://127.0.0.1:9/");
    const frames = await page.evaluate(async (bytes) => {
        const decoder = new ImageDecoder({ type: "image/png", data: new Uint8Array(bytes) });
        await Promise.all([decoder.completed, decoder.tracks.ready]);
        const frames = [];
        for (let frameIndex = 0; frameIndex < decoder.tracks.selectedTrack.frameCount; frameIndex++) {
            const { image } = await decoder.decode({ frameIndex });
            const canvas = new OffscreenCanvas(image.displayWidth, image.displayHeight);
            canvas.getContext("2d").drawImage(image, 0, 0);
            frames.push({ shown: image.duration / 1000, bytes: [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data] });
        }
        return frames;
    }, [...bytes]);
    await page.context().close();
    return frames.map(({ shown, bytes }) => ({
        shown,
        pixels: Uint32Array.from({ length: bytes.length / 4 }, (_, k) => (bytes[4 * k] << 16) | (bytes[4 * k + 1] << 8) | bytes[4 * k + 2]),
    }));
}

test("a film has its frames, pixel by pixel, and their times", async () => {
    // one that moves, one that stays as it was, and one from which something is gone
    const frames = [frame(0), frame(7, { shown: 1500 }), frame(7), frame(30, { colours: 9 }), frame(30)];
    const seen = await decoded(written(frames));
    assert.deepEqual(seen.map(({ shown }) => shown), [100, 1500, 100, 100, 100]);
    frames.forEach(({ pixels }, k) => assert.deepEqual(seen[k].pixels, pixels, `frame ${k}`));
});

test("a still has its pixels; of more colours than there are the rare ones are near", async () => {
    const still = frame(3);
    assert.deepEqual((await decoded(written([still])))[0].pixels, still.pixels);
    const many = frame(3, { colours: 400 });
    const [{ pixels }] = await decoded(written([many]));
    const away = (a, b) => Math.max(...[16, 8, 0].map((bits) => Math.abs(((a >> bits) & 255) - ((b >> bits) & 255))));
    assert.ok(pixels.every((colour, k) => away(colour, many.pixels[k]) < 32));
});

test("a picture of a browser is read as the browser has it", async () => {
    const page = await (await (await browser()).newContext({ viewport: { width: 300, height: 200 } })).newPage();
    await page.setContent("<body style='background: linear-gradient(45deg, red, blue)'><h1>Ωmega</h1>");
    const bytes = await page.screenshot();
    const [{ pixels }] = await decoded(bytes);
    assert.deepEqual(read(bytes).pixels, pixels);
    await page.context().close();
});
