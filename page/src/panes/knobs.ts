// Sliders for all params and inputs of a file that is followed.

import type { Document } from "../data/document.ts";
import type { Jog, Knob } from "../data/live.ts";
import { html } from "../elements.ts";
import type { Moment } from "../motion/motion.ts";
import { set as setUnit, short } from "../numbers.ts";
import type { Pane } from "./pane.ts";

export interface Deeds {
    /** A param (in its unit) or an input (SI) is to have a value. */
    set(name: string, value: number): void;
    /** What an input is now (SI). */
    value(name: string): number;
    asInFile(): void;
    timeAgain(): void;
    /** Writes what is set into the file; says why not. */
    write(sure: boolean): Promise<Refusal | undefined>;
}

/** Why nothing is written; it may be if the reader says so. */
export interface Refusal {
    says: string;
    isQuestion?: boolean;
}

/** Steps of a slider. */
const STEPS = 400;
/** A slider goes from its value by so much of it to both sides. */
const AROUND = 0.5;
/** An angle's slider goes so far to both sides, by unit. */
const TURN: Record<string, number> = { deg: 180, rad: Math.PI, rev: 0.5 };
/** Params from here on are folded away at first. */
const MANY = 6;

interface Row {
    slider: HTMLInputElement;
    field: HTMLInputElement;
    label: HTMLElement;
    /** What it is as long as nobody sets it; nothing of an input, which time moves. */
    own: number | undefined;
}

export class Knobs implements Pane {
    readonly element = html("section", { class: "knobs", "aria-label": "params and inputs" });
    private readonly rows = new Map<string, Row>();
    private readonly turning = html("div", { class: "turning", role: "group", "aria-label": "inputs" });
    private readonly setting = html("div", { class: "setting", role: "group", "aria-label": "params" });
    private readonly folded = html("details", { class: "params" }, html("summary", {}, "Params"), this.setting);
    private readonly deeds = html("div", { class: "deeds" });
    private readonly time = html("button", { type: "button", class: "time-again", hidden: true, title: "inputs follow their formulas again" }, "time");
    private readonly told = html("span", { class: "told", role: "status" });
    private offered = "";
    private knobs: readonly Knob[] = [];
    private jogs: readonly Jog[] = [];
    private set: ReadonlyMap<string, number> = new Map();

    constructor(private readonly does: Deeds) {
        const button = (shows: string, title: string, click: () => void) => {
            const made = html("button", { type: "button", title }, shows);
            made.addEventListener("click", click);
            return made;
        };
        this.time.addEventListener("click", () => does.timeAgain());
        this.deeds.append(
            button("Copy as --set", "what is set, for mechc run --lead", () => void this.copy()),
            button("Write into the file", "what is set takes the place of what the file says", () => void this.write()),
            button("As in the file", "params are what the file says again", () => does.asInFile()),
            this.told,
        );
        this.element.append(this.turning, this.folded, this.deeds);
        this.deeds.hidden = true;
    }

    /** What there is to turn; sliders that a hand may hold stay. */
    offer(knobs: readonly Knob[], jogs: readonly Jog[], set: ReadonlyMap<string, number>): void {
        const offered = JSON.stringify([knobs.map((knob) => ({ ...knob, now: null })), jogs]);
        [this.knobs, this.jogs] = [knobs, jogs];
        if (offered !== this.offered) {
            const wasEmpty = this.offered === "";
            this.offered = offered;
            this.rows.clear();
            this.setting.replaceChildren(...knobs.map((knob) => this.row(knob.name, knob.unit, knob.value, rangeOf(knob), knob.whole ? 1 : undefined, knob.formula)));
            const sliders = jogs.map((jog) => this.row(jog.name, jog.unit, 0, TURN[jog.unit] ? [-2 * TURN[jog.unit]!, 2 * TURN[jog.unit]!] : [-1, 1], "any", jog.formula));
            this.turning.replaceChildren(...(jogs.length > 0 ? [...sliders, this.time] : []));
            if (wasEmpty) this.folded.open = knobs.length < MANY;
            this.folded.hidden = knobs.length === 0;
        }
        // a formula follows what is set
        for (const { name, value, now } of knobs) this.rows.get(name)!.own = now ?? value;
        this.element.hidden = this.rows.size === 0;
        this.at(set, new Map());
    }

    /** What is set by now. */
    at(set: ReadonlyMap<string, number>, moved: ReadonlyMap<string, number>): void {
        this.set = set;
        for (const [name, row] of this.rows) {
            const value = set.get(name) ?? moved.get(name) ?? row.own;
            if (value !== undefined) show(row, value);
            row.label.classList.toggle("changed", set.has(name) || moved.has(name));
        }
        this.deeds.hidden = set.size === 0;
        this.time.hidden = moved.size === 0;
        this.told.textContent = "";
    }

    show(_: Document): void {}

    /** What no hand has moved is what it is now. */
    draw(_: Moment): void {
        for (const jog of this.jogs) {
            const row = this.rows.get(jog.name)!;
            if (!row.label.classList.contains("changed")) show(row, this.does.value(jog.name));
        }
    }

    private row(name: string, unit: string, value: number, [from, to]: [number, number], by: number | "any" | undefined, formula: string | null): HTMLElement {
        const slider = html("input", { type: "range", min: from, max: to, step: by ?? step(from, to), value, "data-param": name, "aria-label": name });
        const field = html("input", { type: "text", inputmode: "decimal", size: 8, "aria-label": `${name}, a number`, spellcheck: "false" });
        const label = html(
            "div",
            { class: "knob", title: formula ?? undefined },
            html("span", { class: "name" }, name),
            slider,
            field,
            html("span", { class: "unit" }, setUnit(unit)),
        );
        const row: Row = { slider, field, label, own: undefined };
        this.rows.set(name, row);
        slider.addEventListener("input", () => this.does.set(name, Number(slider.value)));
        field.addEventListener("change", () => {
            const typed = numberIn(field.value, unit);
            field.value = short(typed ?? Number(slider.value));
            if (typed !== undefined) this.does.set(name, typed);
        });
        show(row, value);
        return label;
    }

    private async copy(): Promise<void> {
        const options = [...this.set].map(([name, value]) => {
            const unit = this.knobs.find((knob) => knob.name === name)?.unit ?? "";
            const text = `${name}=${value}${unit.startsWith("/") || unit === "" ? "" : " "}${unit}`;
            return `--set ${/^[\w.=\-+]+$/.test(text) ? text : `'${text}'`}`;
        });
        const text = options.join(" ");
        await navigator.clipboard.writeText(text).then(
            () => (this.told.textContent = "copied"),
            () => (this.told.textContent = text),
        );
    }

    private async write(sure = false): Promise<void> {
        const why = await this.does.write(sure);
        this.told.textContent = why?.says ?? "";
        if (!why?.isQuestion) return;
        const [replace, leave] = ["Replace", "Leave it"].map((shows) => html("button", { type: "button" }, shows));
        replace!.addEventListener("click", () => void this.write(true));
        leave!.addEventListener("click", () => (this.told.textContent = ""));
        this.told.append(" ", replace!, " ", leave!);
        replace!.focus();
    }
}

/** What was typed, with the unit behind it or without. */
function numberIn(typed: string, unit: string): number | undefined {
    const text = typed.trim();
    const bare = unit !== "" && text.endsWith(unit) ? text.slice(0, -unit.length).trim() : text;
    const number = Number(bare.replace(/\u2212/g, "-").replace(",", "."));
    return bare === "" || !Number.isFinite(number) ? undefined : number;
}

/** A number that its slider may not reach moves the slider's end. */
function show({ slider, field }: Row, value: number): void {
    if (!Number.isFinite(value)) return;
    if (value < Number(slider.min)) slider.min = String(value);
    if (value > Number(slider.max)) slider.max = String(value);
    slider.value = String(value);
    if (document.activeElement !== field) field.value = short(value);
    slider.setAttribute("aria-valuetext", short(value));
}

/** From where to where a param goes. */
function rangeOf({ value, unit, whole }: Knob): [number, number] {
    const turn = TURN[unit];
    if (turn !== undefined) return [value - turn, value + turn];
    if (whole) return [Math.min(value, 1), 2 * Math.abs(value) + 2];
    const around = value === 0 ? (unit === "mm" ? 50 : 1) : AROUND * Math.abs(value);
    return [round(value - around), round(value + around)];
}

/** A step that a reader would choose. */
function step(from: number, to: number): number {
    const least = (to - from) / STEPS;
    const power = 10 ** Math.floor(Math.log10(least));
    return Number((power * (least / power < 2 ? 1 : least / power < 5 ? 2 : 5)).toPrecision(1));
}

function round(value: number): number {
    return Number(value.toPrecision(4));
}
