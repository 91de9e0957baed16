// A film of a page: screenshots, one after the other, in which a hand is seen, and what it does is said.

import { read } from "./png.mjs";

/** How long a frame of something that moves is shown, one of something that has come to rest, and a new line (ms). */
const MOVING = 80;
const RESTING = 1500;
const SAID = 1000;
/** What follows a hand has come by then (ms). */
const FOLLOWED = 350;

export class Film {
    frames = [];

    constructor(page) {
        this.page = page;
    }

    /** The page gets a line of words and a pointer, which are no part of it. */
    static async of(page) {
        await page.evaluate(() => {
            const line = document.createElement("div");
            line.id = "film-line";
            Object.assign(line.style, { position: "fixed", top: "10px", right: "16px", padding: "4px 12px", borderRadius: "6px", background: "#1f2a44", color: "white", font: "600 17px sans-serif", zIndex: 99 });
            const pointer = document.createElementNS("http://www.w3.org/2000/svg", "svg");
            pointer.setAttribute("viewBox", "0 0 24 24");
            Object.assign(pointer.style, { position: "fixed", left: "0", top: "0", width: "26px", height: "26px", pointerEvents: "none", zIndex: 99, display: "none" });
            const arrow = document.createElementNS("http://www.w3.org/2000/svg", "path");
            arrow.setAttribute("d", "M4 2 L4 19 L8.5 15 L11.5 21.5 L14.5 20 L11.5 14 L17.5 14 Z");
            Object.assign(arrow.style, { fill: "black", stroke: "white", strokeWidth: "1.5" });
            pointer.append(arrow);
            document.body.append(line, pointer);
            addEventListener("pointermove", ({ clientX, clientY }) => Object.assign(pointer.style, { display: "block", transform: `translate(${clientX - 4}px, ${clientY - 2}px)` }), true);
        });
        return new Film(page);
    }

    async frame(shown = MOVING) {
        this.frames.push({ ...read(await this.page.screenshot()), shown });
    }

    async says(words) {
        await this.page.evaluate((words) => (document.querySelector("#film-line").textContent = words), words);
        await this.frame(SAID);
    }

    /** What is there now can be read. */
    async rests() {
        await this.page.waitForTimeout(FOLLOWED);
        await this.frame(RESTING);
    }

    /** The hand takes something through some places. */
    async drags(places) {
        await this.page.mouse.move(...places[0]);
        await this.frame(4 * MOVING);
        await this.page.mouse.down();
        for (const place of places.slice(1)) {
            await this.page.mouse.move(...place);
            await this.page.waitForTimeout(FOLLOWED);
            await this.frame();
        }
        await this.page.mouse.up();
    }

    async clicks(selector) {
        const { x, y, width, height } = await this.page.locator(selector).first().boundingBox();
        await this.page.mouse.move(x + width / 2, y + height / 2);
        await this.frame(8 * MOVING);
        await this.page.mouse.down();
        await this.page.mouse.up();
        await this.page.waitForTimeout(FOLLOWED);
        await this.frame(8 * MOVING);
    }
}
