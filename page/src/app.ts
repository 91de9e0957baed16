// The page's parts, laid out, and what goes between them. A document comes in from outside (`show`); time goes on by the browser's frames.

import type { Document, Source } from "./data/document.ts";
import type { Page } from "./data/format.ts";
import { button, html, press, sign } from "./elements.ts";
import { keys } from "./keys.ts";
import { Clock } from "./motion/clock.ts";
import type { Moment } from "./motion/motion.ts";
import type { Grasp } from "./live/hand.ts";
import { Closer } from "./panes/closer.ts";
import { help } from "./panes/help.ts";
import type { Deeds, Pane } from "./panes/pane.ts";
import { Picture } from "./panes/picture.ts";
import { Plots } from "./panes/plots.ts";
import { Results } from "./panes/results.ts";
import { Rows } from "./panes/rows.ts";
import { Tabs } from "./panes/tabs.ts";
import { Text } from "./panes/text.ts";
import { Transport } from "./panes/transport.ts";
import { Variants, variantOf } from "./panes/variants.ts";
import { Wishes, type Change } from "./wishes.ts";

/** A frame that comes later than this is no step of the motion: the page was not looked at (s). */
const LONGEST_FRAME = 0.25;
/** Frames that the pace is the median of. */
const PACE = 60;
/** What can be switched on: the key, the wish, in words. */
const SWITCHES = [
    ["L", "labels", "Labels"],
    ["V", "vectors", "Vectors"],
    ["N", "forces", "Forces"],
    ["T", "traces", "Traces"],
    ["S", "strobe", "Strobe"],
] as const;

type Switch = (typeof SWITCHES)[number][1];

/** What a page has that follows a file. */
export interface Following {
    /** Sliders, in the place of those of variants. */
    readonly knobs: Pane;
    /** What the program has to say. */
    readonly said: HTMLElement;
    /** What can be taken by the hand in the picture. */
    readonly hand: Grasp;
    /** Time goes on: nothing stands still any more. */
    timeMoves(): void;
    /** A place of the file was chosen (UTF-16). */
    show(at: number): void;
}

export class App implements Deeds {
    readonly element = html("div", { class: "app" });
    readonly picture = new Picture();
    private readonly alone = button("the picture alone", sign("M3 5h18v11H3zM12 16v4M8 20h8"), { title: "the picture alone (F)", "aria-pressed": "false" });
    private readonly clock = new Clock();
    private readonly wishes = new Wishes();
    private readonly transport = new Transport(this.clock, this);
    private readonly plots = new Plots(this);
    private readonly variants: Variants;
    /** What a reader looks at who moves something, and what is a moment later when it is another motion. */
    private readonly near: Pane[];
    private readonly far: Pane[];
    private isBehind = false;
    private readonly helping: HTMLDialogElement;
    private readonly switches = new Map<Switch, HTMLButtonElement>();
    private document: Document | undefined;
    private moment: Moment | undefined;
    /** Whether there was a motion yet, which says how fast it goes. */
    private hasMoved = false;
    private before: number | undefined;
    private wanted = 0;
    private inputs: ReadonlyMap<string, Float64Array> = new Map();
    /** Whether the picture is that of a moment of another motion, which is not there yet. */
    private isGlimpse = false;
    /** Where everything stands while inputs are moved by hand. */
    private standing: Document | undefined;
    private chosen: number | undefined;
    private readonly times: { between: number; drawing: number }[] = [];

    constructor(
        readonly page: Page,
        private readonly source: Source,
        private readonly following?: Following,
    ) {
        this.alone.addEventListener("click", () => this.lecture());
        this.picture.views.append(this.alone);
        this.variants = new Variants(page, (variant) => void this.turnTo(variant));
        this.helping = help(page.mechc);
        const text = new Text();
        const rows = new Rows(() => this.plots.plotted, this);
        const closer = new Closer((name) => this.plots.add(name));
        const results = new Results(this);
        // a slider that is held stays where it is when there is something to say
        results.keepRoom(page.variants.length > 1 && page.variants.some(({ messages }) => messages.length > 0));
        this.element.classList.toggle("varies", page.vary.length > 0);
        this.plots.whenPlotted(() => rows.plottedAnew());
        const knobs = following?.knobs;
        this.picture.hand = following?.hand;
        this.near = [this.picture, this.transport, knobs ?? this.variants];
        this.far = [results, this.plots, text, closer, rows];
        const tabs = new Tabs([["Text", text.element], ["Closer look", closer.element], ["Table", rows.element]], () => this.draw());
        this.element.append(
            html(
                "div",
                { class: "stage" },
                html("div", { class: "frame" }, this.picture.element, this.toolbar()),
                this.transport.element,
                (knobs ?? this.variants).element,
                ...(following ? [] : [results.element]),
            ),
            // what comes and goes takes no room from a picture that is in somebody's hand
            html("div", { class: "beside" }, this.plots.element, ...(following ? [following.said, results.element] : []), tabs.element),
            this.helping,
        );
        this.wishes.onChange((change) => this.wish(change));
        keys(this.keyed());
        const print = () => {
            this.plots.print();
            text.print();
        };
        addEventListener("beforeprint", print);
        matchMedia("print").addEventListener("change", print);
    }

    get firstVariant(): number {
        return variantOf(this.page, this.page.vary.map(({ nearest }) => nearest));
    }

    get time(): number {
        return this.clock.time;
    }

    get shown(): Document | undefined {
        return this.standing ?? this.document;
    }

    get pace(): { between: number; drawing: number } {
        const middle = (of: number[]) => of.sort((a, b) => a - b)[of.length >> 1] ?? NaN;
        return { between: middle(this.times.map((time) => time.between)), drawing: middle(this.times.map((time) => time.drawing)) };
    }

    /** Another motion takes the place of what was shown; time stays where it is. */
    show(document: Document): void {
        const { from, to } = document.motion;
        const { rows } = document.table;
        this.document = document;
        this.standing = undefined;
        this.plots.stand(undefined);
        this.isGlimpse = false;
        this.moment = document.motion.moment();
        // what is broken has no time of its own, and takes none away
        if (rows > 0) this.clock.span(from, to, !this.hasMoved);
        this.hasMoved ||= rows > 1;
        this.element.classList.toggle("still", document.table.rows < 2);
        const forces = this.switches.get("forces");
        if (forces) forces.hidden = !document.scene.forces && !document.scene.torques;
        for (const pane of this.near) pane.show(document, this.wishes);
        this.isBehind = true;
        this.draw();
        void painted().then(() => this.catchUp());
    }

    /** A moment of another motion, which follows; until then the picture alone is of it. */
    glimpse(document: Document): void {
        this.isGlimpse = true;
        this.picture.glimpse(document, document.motion.atRow(0, document.motion.moment()));
    }

    /** The motion that was glimpsed does not follow. */
    goBack(): void {
        if (this.isGlimpse && this.document) this.show(this.document);
    }

    /** All is of the document whose picture is shown. */
    private catchUp(): void {
        const { document, moment } = this;
        if (!this.isBehind || !document || !moment) return;
        this.isBehind = false;
        for (const pane of this.far) {
            pane.show(document, this.wishes);
            pane.draw(moment);
        }
    }

    /** Settles when everything that was changed is on the screen. */
    async drawn(): Promise<void> {
        this.catchUp();
        await frame();
    }

    /** Shows where inputs that are moved by hand have brought everything; time stands still. */
    stand(at: Document | undefined): void {
        this.standing = at;
        this.plots.stand(at);
        this.draw();
    }

    /** The values of inputs (SI), a row each. */
    takeInputs(values: readonly (readonly [name: string, values: Float64Array])[]): void {
        this.inputs = new Map(values);
    }

    /** What an input is now (SI). */
    input(name: string): number {
        const table = this.document?.table;
        return this.inputs.get(name)?.[table?.nearest(this.time) ?? 0] ?? NaN;
    }

    /** An editor's cursor is at a place of the file, or of one that it uses (UTF-16): what is declared there is lit. */
    point(at: number | null, file: string | null): void {
        const { scene, page } = this.document ?? {};
        const declarations = scene?.declarations ?? [];
        const here = file === null ? 0 : (page?.texts.findIndex(({ name }) => name === file) ?? -1);
        let inner: number | undefined;
        declarations.forEach(([, , text, from, to], number) => {
            if (at === null || text !== here || at < from || at > to || to <= from) return;
            const [, , , begin, end] = inner === undefined ? [0, 0, 0, -Infinity, Infinity] : declarations[inner]!;
            if (to - from < end - begin) inner = number;
        });
        this.wishes.point(inner === undefined ? [] : [inner]);
    }

    /** Begins to move, unless the reader asked for little motion. */
    begin(): void {
        this.catchUp();
        if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
        this.draw();
        this.source.prepare?.();
    }

    play(): void {
        if (this.clock.playing || (this.document?.table.rows ?? 0) < 2) return;
        this.goOn();
        this.clock.playing = true;
        this.before = undefined;
        this.times.length = 0;
        requestAnimationFrame((now) => this.frame(now));
        this.draw();
    }

    pause(): void {
        if (!this.clock.playing) return;
        this.clock.playing = false;
        this.draw();
        this.transport.say();
    }

    seek(time: number): Promise<void> {
        this.goOn();
        this.clock.go(time);
        this.draw();
        if (!this.clock.playing) this.transport.say();
        return this.drawn();
    }

    step(rows: number): void {
        const { document } = this;
        if (!document || document.table.rows === 0) return;
        this.pause();
        const { table } = document;
        const here = table.rowAt(this.time);
        // between two rows a step back goes to the one before
        const from = rows < 0 && table.times[here]! < this.time ? here + 1 : here;
        const row = Math.min(Math.max(from + rows, 0), table.rows - 1);
        void this.seek(table.times[row]!);
    }

    async set(name: string, value: number): Promise<void> {
        await this.turnTo(this.variants.nearest(name, value));
        await this.drawn();
    }

    private async turnTo(variant: number): Promise<void> {
        const turn = ++this.wanted;
        const document = await this.source.document(variant);
        // what was asked for meanwhile comes later
        if (turn === this.wanted) this.show(document);
    }

    private goOn(): void {
        this.standing = undefined;
        this.plots.stand(undefined);
        this.following?.timeMoves();
    }

    private frame(now: number): void {
        if (!this.clock.playing) return;
        const began = performance.now();
        const seconds = this.before === undefined ? 0 : (now - this.before) / 1000;
        if ((this.document?.table.rows ?? 0) > 1) this.clock.advance(Math.min(seconds, LONGEST_FRAME));
        this.draw();
        if (this.before !== undefined) this.times.push({ between: now - this.before, drawing: performance.now() - began });
        if (this.times.length > PACE) this.times.shift();
        this.before = now;
        requestAnimationFrame((next) => this.frame(next));
    }

    private draw(): void {
        const { document, moment } = this;
        if (!document || !moment) return;
        (this.standing ?? document).motion.at(this.time, moment);
        if (this.standing) moment.row = document.table.rowAt(this.time);
        for (const pane of this.near) if (pane !== this.picture || !this.isGlimpse) pane.draw(moment);
        if (!this.isBehind) for (const pane of this.far) pane.draw(moment);
    }

    private wish(change: Change): void {
        if (!this.document) return;
        if (change === "wish") this.isGlimpse = false;
        this.catchUp();
        for (const pane of [...this.near, ...this.far]) {
            if (change === "pointer") pane.light?.(this.wishes);
            else pane.show(this.document, this.wishes);
        }
        if (change === "pointer") return;
        this.tellChosen();
        for (const [wish, made] of this.switches) press(made, this.wishes[wish]);
        this.draw();
    }

    /** What is chosen is shown in the editor. */
    private tellChosen(): void {
        const { chosen } = this.wishes;
        if (chosen === this.chosen) return;
        this.chosen = chosen;
        const [, , text, from, to] = this.document?.scene.declarations[chosen ?? -1] ?? [];
        if (text === 0 && from! < to!) this.following?.show(from!);
    }

    /** The picture alone, or everything again. */
    private lecture(): void {
        const isAlone = this.element.classList.toggle("lecture");
        press(this.alone, isAlone);
        this.picture.resized();
    }

    private flip(wish: Switch): void {
        this.wishes.change((wishes) => (wishes[wish] = !wishes[wish]));
    }

    private toolbar(): HTMLElement {
        const bar = html("div", { class: "toolbar", role: "toolbar", "aria-label": "what is shown" });
        for (const [key, wish, shown] of SWITCHES) {
            const made = button(shown, shown, { title: `${shown} (${key})` });
            press(made, this.wishes[wish]);
            made.addEventListener("click", () => this.flip(wish));
            this.switches.set(wish, made);
            bar.append(made);
        }
        const asks = button("help", "?", { class: "asks" });
        asks.addEventListener("click", () => this.helping.showModal());
        bar.append(asks);
        return bar;
    }

    private keyed(): Record<string, () => void> {
        const flips = SWITCHES.map(([key, wish]) => [key.toLowerCase(), () => this.flip(wish)]);
        return {
            ...(Object.fromEntries(flips) as Record<string, () => void>),
            " ": () => (this.clock.playing ? this.pause() : this.play()),
            ArrowLeft: () => this.step(-1),
            ArrowRight: () => this.step(1),
            "Shift ArrowLeft": () => this.step(-10),
            "Shift ArrowRight": () => this.step(10),
            Home: () => this.end(-1),
            End: () => this.end(1),
            "+": () => this.transport.change(() => this.clock.faster()),
            "-": () => this.transport.change(() => this.clock.slower()),
            b: () => this.transport.turnOver(),
            f: () => this.lecture(),
            "0": () => this.picture.whole(),
            "?": () => this.helping.showModal(),
        };
    }

    /** To the begin or the end. */
    private end(which: -1 | 1): void {
        this.pause();
        void this.seek(which < 0 ? -Infinity : Infinity);
    }
}

function frame(): Promise<void> {
    return new Promise((resolve) => requestAnimationFrame(() => resolve()));
}

/** When what was changed is on the screen. */
async function painted(): Promise<void> {
    await frame();
    await new Promise((resolve) => setTimeout(resolve));
}
