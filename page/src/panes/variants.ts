// Sliders for what was varied beforehand.

import type { Document, Source } from "../data/document.ts";
import type { Page } from "../data/format.ts";
import { html } from "../elements.ts";
import type { Moment } from "../motion/motion.ts";
import { short, withUnit } from "../numbers.ts";
import type { Pane } from "./pane.ts";

export class Variants implements Pane {
    readonly element = html("div", { class: "variants", role: "group", "aria-label": "parameters" });
    private readonly sliders: { slider: HTMLInputElement; value: HTMLOutputElement }[];
    /** Of each that varies, which of its values holds. */
    private readonly chosen: number[];

    constructor(
        private readonly page: Page,
        private readonly wanted: (variant: number) => void,
    ) {
        this.chosen = page.vary.map(({ nearest }) => nearest);
        const said: string[] = [];
        this.sliders = page.vary.map(({ name, unit, values, own }, place) => {
            const slider = html("input", { type: "range", min: 0, max: values.length - 1, step: 1, "data-param": name });
            const value = html("output", {});
            this.element.append(html("label", {}, html("span", { class: "name" }, name), slider, value));
            if (own !== null) said.push(`${name} is ${withUnit(short(own), unit)} in the text`);
            // what is told has the same room always, and so has the slider
            value.style.minWidth = `${Math.max(...values.map((value) => withUnit(short(value), unit).length))}ch`;
            slider.addEventListener("input", () => {
                this.chosen[place] = Number(slider.value);
                this.tell();
                this.wanted(this.variant);
            });
            return { slider, value };
        });
        this.element.hidden = page.vary.length === 0;
        const size = page.bytes === undefined ? "" : `; this page has ${Math.ceil(page.bytes / 1000)} kB`;
        said.push(`${page.variants.length} variants, solved beforehand${size}`);
        this.element.append(html("p", {}, `${said.join(". ")}.`));
        this.tell();
    }

    /** Its place in the product of all that varies. */
    get variant(): number {
        return variantOf(this.page, this.chosen);
    }

    /** The variant where a param has the nearest of its values (in its unit). */
    nearest(name: string, value: number): number {
        const place = this.page.vary.findIndex((vary) => vary.name === name);
        if (place < 0) throw new Error(`nothing was varied that is called ${name}`);
        const away = this.page.vary[place]!.values.map((at) => Math.abs(at - value));
        this.chosen[place] = away.indexOf(Math.min(...away));
        this.tell();
        return this.variant;
    }

    show(_: Document): void {}

    draw(_: Moment): void {}

    private tell(): void {
        this.sliders.forEach(({ slider, value }, place) => {
            const { values, unit } = this.page.vary[place]!;
            const text = withUnit(short(values[this.chosen[place]!]!), unit);
            slider.value = String(this.chosen[place]);
            slider.setAttribute("aria-valuetext", text);
            value.textContent = text;
        });
    }
}

/** The place of some values in the product of all, the last fastest. */
export function variantOf({ vary }: Source["page"], chosen: readonly number[]): number {
    return vary.reduce((sum, { values }, place) => sum * values.length + chosen[place]!, 0);
}
