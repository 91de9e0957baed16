// Sliders for all params and inputs of a file that is followed.

import type { Document } from "../data/document.ts";
import type { Jog, Knob } from "../data/live.ts";
import { typedIn } from "../data/typed.ts";
import { html } from "../elements.ts";
import type { Moment, Pair } from "../motion/motion.ts";
import { set as setUnit, short, siUnit, six, withUnit } from "../numbers.ts";
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
    /** Says something that is not about what is set. */
    say(text: string): void;
}

/** Why nothing is written; it may be if the reader says so. */
export interface Refusal {
    says: string;
    isQuestion?: boolean;
}

/** What inputs are over time (SI), and how much of the plane is drawn (m): from where to where sliders go. */
export interface Reach {
    inputs: ReadonlyMap<string, Float64Array>;
    extent: readonly [Pair, Pair];
}

/** Steps of a slider, and of one of a place or of an input. */
const STEPS = 400;
const FINE_STEPS = 1000;
/** A slider goes from its value by so much of it to both sides. */
const AROUND = 0.5;
/** An angle's slider goes so far to both sides, by unit. */
const TURN: Record<string, number> = { deg: 180, rad: Math.PI, rev: 0.5 };
/** An input that goes on turning something goes so many turns to both sides at least. */
const TURNS = 2;
/** Params from here on are folded away at first. */
const MANY = 6;

/** A param or an input, as it is shown. */
type Turned = Pick<Knob, "name" | "unit" | "si" | "dimension" | "formula">;

interface Row {
    slider: HTMLInputElement;
    field: HTMLInputElement;
    label: HTMLElement;
    range: Range;
    /** What it is as long as nobody sets it; nothing of an input, which time moves. */
    own: number | undefined;
    /** What is shown, of which a slider has only steps. */
    value: number;
    /** Whether somebody is writing in the field: until what is written is taken, nothing else is shown there. */
    isEdited: boolean;
}

/** From where to where a slider goes, in which steps. */
type Range = readonly [from: number, to: number, by: number];

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
    private reach: Reach = { inputs: new Map(), extent: [[0, 0], [0, 0]] };
    private isSet = "";
    /** What one of an input's unit is in SI. */
    private sizes: ReadonlyMap<string, number> = new Map();

    constructor(private readonly does: Deeds) {
        const button = (shows: string, title: string, click: () => void) => {
            const made = html("button", { type: "button", title }, shows);
            made.addEventListener("click", click);
            return made;
        };
        this.time.addEventListener("click", () => does.timeAgain());
        this.deeds.append(
            button("Copy as --set", "what is set, as options of mechc run", () => void this.copy()),
            button("Write into the file", "what is set takes the place of what the file says", () => void this.write()),
            button("As in the file", "params are what the file says again", () => this.asInFile()),
            this.told,
        );
        this.element.append(this.turning, this.folded, this.deeds);
        this.deeds.hidden = true;
    }

    /** What there is to turn; sliders that a hand may hold stay. */
    offer(knobs: readonly Knob[], jogs: readonly Jog[], set: ReadonlyMap<string, number>, reach = this.reach): void {
        const offered = JSON.stringify([knobs.map((knob) => ({ ...knob, now: null })), jogs]);
        [this.knobs, this.jogs, this.reach] = [knobs, jogs, reach];
        if (offered !== this.offered) {
            const wasEmpty = this.offered === "";
            this.offered = offered;
            this.rows.clear();
            this.setting.replaceChildren(...this.rowsOf(knobs, reach));
            const sliders = jogs.map((jog) => {
                const range = rangeOfInput(jog, reach);
                return this.row(jog, range[0], range, (value) => this.does.set(jog.name, value * jog.si));
            });
            this.turning.replaceChildren(...(jogs.length > 0 ? [...sliders, this.time] : []));
            this.sizes = new Map(jogs.map(({ name, si }) => [name, si]));
            if (wasEmpty) this.folded.open = knobs.filter(({ of }) => of === null).length < MANY;
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
            const value = set.get(name) ?? row.own ?? this.inUnit(name, moved.get(name) ?? this.does.value(name));
            show(row, value);
            row.label.classList.toggle("changed", set.has(name) || moved.has(name));
        }
        this.deeds.hidden = set.size === 0;
        this.time.hidden = moved.size === 0;
        const isSet = JSON.stringify([...set]);
        // what was said of other settings
        if (isSet !== this.isSet) this.told.textContent = "";
        this.isSet = isSet;
    }

    /** An input's value (SI) in the unit in which it is shown. */
    private inUnit(name: string, value: number): number {
        return value / (this.sizes.get(name) ?? 1);
    }

    /** Sliders that a number made longer are as long as they were. */
    private asInFile(): void {
        for (const row of this.rows.values()) [row.slider.min, row.slider.max] = [String(row.range[0]), String(row.range[1])];
        this.does.asInFile();
    }

    show(_: Document): void {}

    /** What no hand has moved is what it is now. */
    draw(_: Moment): void {
        for (const jog of this.jogs) {
            const row = this.rows.get(jog.name)!;
            if (!row.label.classList.contains("changed")) show(row, this.inUnit(jog.name, this.does.value(jog.name)));
        }
    }

    /** A row for each param; those of single copies are folded away behind the one of all of them. */
    private rowsOf(knobs: readonly Knob[], reach: Reach): HTMLElement[] {
        const row = (knob: Knob) => this.row(knob, knob.value, rangeOf(knob, reach));
        return knobs.flatMap((knob) => {
            if (knob.of !== null) return [];
            const copies = knobs.filter(({ of }) => of === knob.name);
            if (copies.length === 0) return [row(knob)];
            const each = html("details", { class: "copies" }, html("summary", {}, `each of ${copies.length}`), ...copies.map(row));
            return [html("div", { role: "group", "aria-label": `${knob.name}, of all copies` }, row(knob), each)];
        });
    }

    private row(of: Turned, value: number, range: Range, take = (value: number) => this.does.set(of.name, value)): HTMLElement {
        const { name, unit, formula } = of;
        const [from, to, by] = range;
        const slider = html("input", { type: "range", min: from, max: to, step: by, value, "data-param": name, "aria-label": name });
        const field = html("input", { type: "text", inputmode: "decimal", size: 8, "aria-label": `${name}, a number`, spellcheck: "false" });
        const label = html(
            "div",
            { class: "knob", title: formula ?? undefined },
            html("span", { class: "name" }, name),
            slider,
            field,
            html("span", { class: "unit" }, setUnit(unit)),
        );
        const row: Row = { slider, field, label, range, own: undefined, value, isEdited: false };
        this.rows.set(name, row);
        slider.addEventListener("input", () => take(Number(slider.value)));
        field.addEventListener("input", () => (row.isEdited = true));
        field.addEventListener("pointerenter", () => (field.title = of.si === 1 ? "" : inSi(row.value, of)));
        field.addEventListener("change", () => {
            const typed = typedIn(field.value, of);
            row.isEdited = false;
            this.does.say(typeof typed === "string" ? `${name}: ${typed}` : "");
            field.value = typeof typed === "number" ? short(typed) : slider.getAttribute("aria-valuetext")!;
            if (typeof typed === "number") take(typed);
        });
        // what was written and taken back is no change
        field.addEventListener("blur", () => {
            row.isEdited = false;
            field.value = slider.getAttribute("aria-valuetext")!;
        });
        show(row, value);
        return label;
    }

    private async copy(): Promise<void> {
        const knob = (name: string) => this.knobs.find((knob) => knob.name === name);
        const settings = [...this.set].map(([name, value]) => {
            const unit = knob(name)?.unit ?? "";
            return `${name}=${value}${unit.startsWith("/") || unit === "" ? "" : " "}${unit}`;
        });
        const held = this.knobs.filter(({ name, held }) => held !== null && !this.set.has(name));
        // nothing leads from one number of bodies to another
        const isLed = ![...[...this.set.keys()].map(knob), ...held].some((knob) => knob?.whole);
        const all = [...new Set(held.map(({ held }) => held!)), ...settings];
        const options = [...(isLed ? ["--lead"] : []), ...all.map((text) => `--set ${/^[\w.=\-+]+$/.test(text) ? text : `'${text}'`}`)];
        const text = options.join(" ");
        await navigator.clipboard.writeText(text).then(
            () => (this.told.textContent = "copied"),
            () => (this.told.textContent = text),
        );
    }

    private async write(sure = false): Promise<void> {
        this.deeds.ariaBusy = "true";
        const why = await this.does.write(sure).finally(() => (this.deeds.ariaBusy = null));
        this.told.textContent = why?.says ?? "";
        if (!why?.isQuestion) return;
        const [replace, leave] = ["Replace", "Leave it"].map((shows) => html("button", { type: "button" }, shows));
        replace!.addEventListener("click", () => void this.write(true));
        leave!.addEventListener("click", () => (this.told.textContent = ""));
        this.told.append(" ", replace!, " ", leave!);
        replace!.focus();
    }
}

/** A number that its slider may not reach moves the slider's end. */
function show(row: Row, value: number): void {
    if (!Number.isFinite(value)) return;
    const { slider, field, isEdited } = row;
    row.value = value;
    if (value < Number(slider.min)) slider.min = String(value);
    if (value > Number(slider.max)) slider.max = String(value);
    slider.value = String(value);
    if (!isEdited) field.value = short(value);
    slider.setAttribute("aria-valuetext", short(value));
}

/** A value in its unit, as it is in SI. */
function inSi(value: number, { unit, si }: Turned): string {
    return `${withUnit(six(value * si), siUnit(unit))} (SI)`;
}

/** From where to where a param goes. */
function rangeOf({ name, value, unit, si, whole }: Knob, { extent: [[left, bottom], [right, top]] }: Reach): Range {
    if (whole) return [Math.min(value, 1), 2 * Math.abs(value) + 2, 1];
    const turn = TURN[unit];
    if (turn !== undefined) return around(value, turn, STEPS);
    // a place goes as far as there is something to see
    const size = Math.max(right - left, top - bottom) / si;
    if (/\.[xy]$/.test(name) && size > 0) return around(value, AROUND * size, FINE_STEPS);
    return around(value, value === 0 ? (unit === "mm" ? 50 : 1) : AROUND * Math.abs(value), STEPS);
}

/** From where to where an input goes: as far as time moves it, and on; what swings goes as far again to both sides. */
function rangeOfInput({ name, unit, si, dimension }: Jog, { inputs, extent: [[left, bottom], [right, top]] }: Reach): Range {
    const values = (inputs.get(name)?.filter(Number.isFinite) ?? new Float64Array(0)).map((value) => value / si);
    const [least, most] = values.length > 0 ? [Math.min(...values), Math.max(...values)] : [0, 0];
    const isOneWay = [1, -1].some((way) => values.every((value, k) => k === 0 || way * (value - values[k - 1]!) >= 0));
    if (TURN[unit] && isOneWay) {
        const turns = 2 * TURNS * TURN[unit]!;
        return ended(Math.min(least, -turns), Math.max(most, turns), FINE_STEPS);
    }
    if (TURN[unit]) return ended(2 * least - most, 2 * most - least, FINE_STEPS);
    const usual = dimension === "m" ? (AROUND * Math.max(right - left, top - bottom)) / si : AROUND * Math.abs(most);
    const beyond = AROUND * (most - least) || usual || 1;
    return ended(least - beyond, most + beyond, FINE_STEPS);
}

function around(value: number, by: number, steps: number): Range {
    return ended(value - by, value + by, steps);
}

/** Steps that a reader would choose, on round numbers from end to end. */
function ended(from: number, to: number, steps: number): Range {
    const least = (to - from) / steps;
    const power = Math.floor(Math.log10(least));
    const digit = [1, 2, 5].find((digit) => digit * 10 ** power >= least * 0.999) ?? 10;
    const by = Number((digit * 10 ** power).toPrecision(1));
    const round = (value: number) => Number((value * by).toPrecision(12));
    return [round(Math.floor(from / by + 1e-9)), round(Math.ceil(to / by - 1e-9)), by];
}
