// What is set on a page that follows a file, while the file, its units and its params change.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, test } from "node:test";
import { close } from "./browser.mjs";
import { CRANK, ROCKING, following, looked, served, table, until, written } from "./served.mjs";

after(close);

const shows = (text) => document.querySelector(".source")?.textContent.includes(text);
const click = (page, text) => page.click(`.deeds >> text=${text}`);
const asInFile = (page) => page.evaluate(() => [...document.querySelectorAll(".deeds button")].find((button) => button.textContent === "As in the file").click());
const lift = (page) => page.evaluate(() => mechc.row()[mechc.columns.indexOf("lift")]);
const row = (page) => page.evaluate(() => mechc.row());
const set = (page, name, value) => page.evaluate(([name, value]) => mechc.set(name, value), [name, value]);
const noted = (page) => page.locator(".noted").textContent();

/** A slider: what its field, its unit and its ends say, and whether it is changed. */
function knob(page, name) {
    return page.evaluate((name) => {
        const slider = document.querySelector(`[data-param="${name}"]`);
        const all = slider.closest(".knob");
        const [min, max, step] = [slider.min, slider.max, slider.step].map(Number);
        return { field: all.querySelector("[type=text]").value, unit: all.querySelector(".unit").textContent, min, max, step, isChanged: all.classList.contains("changed") };
    }, name);
}

async function type(page, name, text) {
    const field = page.locator(`.knob:has([data-param="${name}"]) input[type=text]`);
    await field.fill(text);
    await field.press("Enter");
}

test("a setting whose param is gone is kept aside, and does not keep others from being written", async () => {
    await following(CRANK, async ({ server, page }) => {
        await page.evaluate(() => mechc.seek(0));
        await set(page, "rod", 95);
        await set(page, "C.y", 4);
        const before = await lift(page);
        const renamed = CRANK.replaceAll(/\brod\b/g, "bar");
        server.save(renamed);
        await until(page, shows, "param bar");
        await until(page, () => document.querySelector(".aside:not([hidden])"));
        assert.match(await page.textContent(".aside"), /rod = 95 mm/);
        await written(page);
        await until(page, shows, "(100 mm, 4 mm)");
        assert.equal(readFileSync(server.path, "utf8"), renamed.replace("(100 mm, 0)", "(100 mm, 4 mm)"));
        // the text has it again
        server.save(CRANK.replace("(100 mm, 0)", "(100 mm, 4 mm)"));
        await until(page, shows, "param rod");
        await until(page, () => document.querySelector('[data-param="rod"]').closest(".knob").classList.contains("changed"));
        assert.ok(await page.isHidden(".broken"));
        assert.ok(await page.isHidden(".aside"));
        // led there another way, and so the same but for rounding
        await page.waitForFunction((lift) => Math.abs(mechc.row()[mechc.columns.indexOf("lift")] - lift) < 1e-9, before);
        // what it was is another kind of thing now
        server.save(CRANK.replace("rod = 90 mm", "rod = 90 deg/s").replace("rod / 2", "45 mm"));
        await until(page, () => document.querySelector(".aside:not([hidden])"));
        await until(page, () => document.querySelector(".broken").hidden);
    });
});

test("a setting stays as long as it is when the file's unit changes", async () => {
    await following(CRANK, async ({ server, page }) => {
        await page.evaluate(() => mechc.seek(0));
        await set(page, "rod", 95);
        server.save(CRANK.replace("90 mm", "9 cm"));
        await until(page, shows, "rod = 9 cm");
        await until(page, () => document.querySelector('[data-param="rod"]').closest(".knob").querySelector(".unit").textContent === "cm");
        assert.equal((await knob(page, "rod")).field, "9.5");
        assert.ok(await page.isHidden(".broken"));
        await page.evaluate(() => mechc.set("rod", 9.5));
        assert.deepEqual(await row(page), table(server.path, ["--lead", "--set", "rod=9.5 cm", "--at", "0"]).rows[0]);
        await written(page);
        await until(page, shows, "rod = 9.5 cm");
    });
});

test("a slider shows what the command sets, and says so when the file is written", async () => {
    await following(
        CRANK,
        async ({ server, page }) => {
            await page.evaluate(() => mechc.seek(0));
            assert.equal((await knob(page, "rod")).field, "95");
            assert.deepEqual(await row(page), table(server.path, ["--set", "rod=95mm", "--at", "0"]).rows[0]);
            await set(page, "rod", 99);
            await written(page);
            await until(page, shows, "rod = 99 mm");
            assert.equal((await knob(page, "rod")).field, "95");
            assert.match(await noted(page), /goes on with what the command says: --set rod=95mm/);
            await page.waitForFunction((wanted) => mechc.row().at(-1) === wanted, table(server.path, ["--set", "rod=95mm", "--at", "0"]).rows[0].at(-1));
        },
        { options: ["--set", "rod=95mm"] },
    );
});

test("what decides a repetition is copied as it was computed", async () => {
    const kinds = CRANK.replace("param C", "param flags = 2\n    param C").replace(
        "    joint main",
        "    body flag[k in 0..flags] at (0, 0, 0) { point O = (0, 0)  point P = (0, 5 mm + k * 5 mm) }\n    joint up[k in 0..flags]: weld(ground.O, flag[k].O)\n    joint main",
    );
    await following(kinds, async ({ server, page }) => {
        await page.evaluate(() => Object.defineProperty(navigator, "clipboard", { value: { writeText: (text) => ((window.copied = text), Promise.resolve()) } }));
        const options = async () => {
            await click(page, "Copy as --set");
            const text = await page.evaluate(() => copied);
            return text.match(/'[^']*'|\S+/g).map((word) => word.replaceAll("'", ""));
        };
        await page.evaluate(() => mechc.seek(0));
        await set(page, "rod", 95);
        assert.deepEqual(await options(), ["--lead", "--set", "rod=95 mm"]);
        await set(page, "flags", 3);
        const both = await options();
        assert.ok(!both.includes("--lead"), both.join(" "));
        assert.deepEqual(await row(page), table(server.path, [...both, "--at", "0"]).rows[0]);
    });
});

test("numbers are taken in other units, and refused with a word", async () => {
    await following(CRANK, async ({ page }) => {
        for (const [text, shown, word] of [
            ["95", "95", ""],
            ["9.5 cm", "95", ""],
            ["0.0951 m", "95.1", ""],
            ["95,5", "95.5", ""],
            ["0x60", "90", "is no number"],
            ["95 deg", "90", "is no unit of it"],
            ["95 ells", "90", "unit that is known"],
            ["Infinity", "90", "is no number"],
            ["", "90", "is no number"],
        ]) {
            await asInFile(page);
            await type(page, "rod", text);
            assert.equal((await knob(page, "rod")).field, shown, text);
            if (word) assert.ok((await noted(page)).includes(word), `${text}: ${await noted(page)}`);
            else assert.ok(await page.isHidden(".noted"), text);
        }
    });
});

test("a slider is as long as it was once all is as in the file", async () => {
    await following(CRANK, async ({ page }) => {
        const before = await knob(page, "rod");
        // on round numbers from end to end
        for (const end of [before.min, before.max]) assert.ok(Math.abs(end / before.step - Math.round(end / before.step)) < 1e-6, JSON.stringify(before));
        await type(page, "rod", "500");
        assert.equal((await knob(page, "rod")).max, 500);
        await type(page, "rod", "1e300");
        await page.waitForSelector(".broken:not([hidden]), .message.error");
        await click(page, "As in the file");
        await page.waitForFunction(() => !document.querySelector(".knob.changed"));
        assert.deepEqual(await knob(page, "rod"), before);
    });
});

test("an input goes two turns to both sides, with its unit, whatever its formula is made of", async () => {
    const text = CRANK.replace("param rod", "param speed = 60 rpm\n    param rod").replace("30 deg + 1 rev/s * t", "0.5 + speed * t");
    await following(text, async ({ page }) => {
        const { min, max, unit, step } = await knob(page, "turn");
        assert.equal(unit, "rad");
        assert.ok(min <= -4 * Math.PI && max >= 4 * Math.PI && step < 0.1, JSON.stringify({ min, max, step }));
    });
});

test("an input that swings goes as far as it does, and as far again to both sides", async () => {
    const text = CRANK.replace("30 deg + 1 rev/s * t", "60 deg + 15 deg * sin(1 rev/s * t)");
    await following(text, async ({ page }) => {
        const { min, max, step, unit } = await knob(page, "turn");
        assert.equal(unit, "deg");
        assert.ok(Math.abs(min - 15) < 0.2 && Math.abs(max - 105) < 0.2 && step < 0.3, JSON.stringify({ min, max, step }));
    });
});

test("an input's slider shows what is shown", async () => {
    await following(CRANK, async ({ page }) => {
        await page.evaluate(() => mechc.seek(0.8));
        await set(page, "turn", 1);
        // with this the motion locks up before that time
        await set(page, "C.x", 140);
        await set(page, "turn", 0.7);
        const [{ field }, phi] = [await knob(page, "turn"), await page.evaluate(() => mechc.row()[mechc.columns.indexOf("crank.phi")])];
        assert.ok(Math.abs(Number(field) - (phi * 180) / Math.PI) < 1e-3, `${field} deg and ${phi}`);
        // and what is said of the motion is not said twice
        const told = await page.evaluate(() => [...document.querySelectorAll(".message, .stopped:not([hidden])")].map((said) => said.textContent).filter((said) => said.includes("locks up")).length);
        assert.equal(told, 1);
        await set(page, "C.x", 100);
        await until(page, () => document.querySelector(".stopped").hidden);
    });
});

test("a point is moved by hand to a tenth of a pixel, however far from the origin", async () => {
    const far = CRANK.replace("point O = (0, 0)  point C = C", "point O = (500 m, 0)  point C = C").replace("(100 mm, 0)", "(500.1 m, 0)").replace("at (0, 0, 30 deg)", "at (0 mm, 0, 30 deg)").replaceAll("at (", "at (500 m + ");
    await following(far, async ({ page }) => {
        await page.evaluate(() => mechc.seek(0));
        const handle = page.locator('[data-handle="C"]');
        const box = await handle.boundingBox();
        const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
        await page.mouse.move(x, y);
        await page.mouse.down();
        await page.mouse.move(x + 6, y);
        await page.mouse.move(x + 7, y);
        await page.mouse.up();
        await page.waitForFunction(() => document.querySelector('[data-param="C.x"]').closest(".knob").classList.contains("changed"));
        await until(page, (wanted) => Math.abs(mechc.pins().find(({ point }) => point === "rocker.C").x - wanted) < 0.6, x + 7);
        const { field, step } = await knob(page, "C.x");
        assert.ok(field.length <= 10, field);
        assert.ok(step < 0.001, `${step}`);
    });
});

test("what another file says is not written, is told of, and does not keep others from being written", async () => {
    const arm = "mechanism arm {\n    param length = 70 mm\n    ground { point C = (0, 0) }\n    body bar { point C = (0, 0)  point B = (length, 0) }\n    joint back: revolute(ground.C, bar.C)\n}\n";
    const main = `use "arm.mech"\n${CRANK.replace(/ {4}body rocker.*\n/, "    part rocker: arm() at (C.x, C.y, 0)\n").replace("rocker.B", "rocker.bar.B").replace(/ {4}joint back.*\n/, "")}`;
    await following(
        main,
        async ({ server, page }) => {
            await page.evaluate(() => mechc.seek(0));
            assert.deepEqual([(await knob(page, "rocker.length")).field, (await knob(page, "rocker.length")).unit], ["70", "mm"]);
            await set(page, "rod", 95);
            await set(page, "rocker.length", 72);
            await written(page);
            await until(page, shows, "rod = 95 mm");
            assert.match(await noted(page), /rocker\.length stands in .*arm\.mech:2/);
            assert.ok((await knob(page, "rocker.length")).isChanged);
        },
        { beside: { "arm.mech": arm } },
    );
});

/** Two cranks of one kind, and a third; the kind stands in the same file. */
const COPIES = `mechanism cranks {
    part pair[k in 0..2]: crank() at (k * 100 mm, 0, 0)
    part third: crank() at (0, 100 mm, 0)
    driver turns[k in 0..2]: rotation(pair[k].main) = 1 rev/s * t
    driver turn: rotation(third.main) = 1 rev/s * t
    measure first = x(pair[0].arm.tip) in mm
    measure second = x(pair[1].arm.tip) in mm
    analysis from 0 s to 1 s every 10 ms
}
mechanism crank {
    param reach = 40 mm
    ground { point O = (0, 0) }
    body arm { point O = (0, 0)  point tip = (reach, 0) }
    joint main: revolute(ground.O, arm.O)
}
`;

test("a param of copies has a slider for all of them, and one for each", async () => {
    await following(
        COPIES,
        async ({ server, page }) => {
            await page.evaluate(() => mechc.seek(0));
            const tips = () => page.evaluate(() => ["first", "second"].map((name) => Math.round(mechc.row()[mechc.columns.indexOf(name)] * 1e6) / 1e6));
            assert.equal(await page.isVisible('[data-param="pair.reach"]'), true);
            assert.equal(await page.isVisible('[data-param="pair[0].reach"]'), false, "those of single copies are folded away");
            await set(page, "pair.reach", 50);
            assert.deepEqual(await tips(), [50, 150]);
            assert.equal((await knob(page, "pair[1].reach")).field, "50");
            // the one copy is another one than all, and then as all again
            await set(page, "pair[1].reach", 40);
            assert.deepEqual(await tips(), [50, 140]);
            const lead = ["--lead", "--at", "0", "--mechanism", "cranks"];
            assert.deepEqual(await row(page), table(server.path, ["--set", "pair.reach=50 mm", "--set", "pair[1].reach=40 mm", ...lead]).rows[0]);
            await set(page, "pair.reach", 60);
            assert.deepEqual(await tips(), [60, 160]);
            assert.ok(!(await knob(page, "pair[1].reach")).isChanged);

            // what stands there for others too is written if its reader says so
            assert.match(await written(page), /is that of `third\.reach` too: write 60 mm for all of them\?/);
            assert.equal(readFileSync(server.path, "utf8"), COPIES);
            assert.equal(await written(page, "Replace"), "");
            assert.equal(readFileSync(server.path, "utf8"), COPIES.replace("40 mm", "60 mm"));
            await until(page, shows, "reach = 60 mm");
            assert.deepEqual(await tips(), [60, 160]);
        },
        { options: ["--mechanism", "cranks"] },
    );
});

test("messages cover nothing, and are folded", async () => {
    for (const viewport of [{ width: 1280, height: 900 }, { width: 400, height: 800 }]) {
        // a note of how it was assembled, a motion that locks up, and a jog that stops
        const server = await served(ROCKING.replace("(0, 0, 30 deg)", "(0, 0, 200 deg)").replace("40 deg", "-120 deg"));
        const { page, faults, close } = await looked(server.url, { viewport });
        await page.evaluate(() => mechc.seek(0).then(() => mechc.set("turn", 3)));
        await page.waitForSelector(".stopped:not([hidden])");
        // each thing can be scrolled to where it is on top
        const covered = await page.evaluate(() => {
            const all = [...document.querySelectorAll(".tabbed > .tabs button, .knob input[type=range], .transport button, .message, .text .sheet")];
            return all.filter((one) => {
                one.scrollIntoView({ block: "center" });
                const { left, top, width, height } = one.getBoundingClientRect();
                const on = document.elementFromPoint(left + Math.min(width / 2, 40), top + Math.min(height / 2, 8));
                return !(on && (one.contains(on) || on.contains(one)));
            }).map((one) => one.className || one.textContent);
        });
        assert.deepEqual(covered, []);
        const height = () => page.evaluate(() => document.querySelector(".stopped").getBoundingClientRect().height);
        const isOpen = await page.evaluate(() => document.querySelector(".stopped details").open);
        assert.equal(isOpen, viewport.width > 1000);
        const before = await height();
        await page.click(".stopped summary");
        assert.ok(isOpen ? (await height()) < before / 2 : (await height()) > 1.5 * before, `${before} and ${await height()}`);
        // nothing of what is said is cut off
        if (!isOpen) assert.ok(await page.evaluate(() => [...document.querySelectorAll(".stopped .marking")].every(({ scrollWidth, clientWidth }) => scrollWidth <= clientWidth + 1)));
        assert.deepEqual(faults, []);
        await close();
        await server.end();
    }
});
