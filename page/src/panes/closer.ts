// A closer look: the values of what is chosen, and a lecture's constructions.

import { declareAlike, type Document } from "../data/document.ts";
import type { Anchor } from "../data/format.ts";
import { METRE, inUnit, lengthUnit, type LengthUnit } from "../data/lengths.ts";
import { button, choice, fill, html, press } from "../elements.ts";
import { degrees } from "../layers/constructions.ts";
import { pressure, transmission } from "../motion/angles.ts";
import { anchors, meetings } from "../motion/meetings.ts";
import type { Moment } from "../motion/motion.ts";
import { pole } from "../motion/poles.ts";
import { six, withUnit } from "../numbers.ts";
import { toggle, type Wishes } from "../wishes.ts";
import { factsOf } from "./facts.ts";
import type { Pane } from "./pane.ts";
import { PRESSURE, TRANSMISSION } from "./series.ts";

const NONE: [string, string] = ["", "–"];

export class Closer implements Pane {
    readonly element = html("section", { class: "pane closer", "aria-label": "a closer look" });
    private readonly parts: (Pane & { element: HTMLElement })[];

    constructor(plot: (name: string) => void) {
        this.parts = [new Values(), new Poles(), new Transmission(plot), new Cam(plot)];
        this.element.append(...this.parts.map(({ element }) => element));
    }

    show(document: Document, wishes: Wishes): void {
        for (const part of this.parts) part.show(document, wishes);
    }

    draw(moment: Moment): void {
        for (const part of this.parts) part.draw(moment);
    }
}

/** What is chosen, and its values now. */
class Values implements Pane {
    readonly element = html("fieldset", {}, html("legend", {}, "Values"));
    private readonly what = choice("of what", [NONE]);
    private readonly vectors = html("button", { type: "button", "aria-pressed": "false" }, "vectors");
    private readonly trace = html("button", { type: "button", "aria-pressed": "false" }, "trace");
    private readonly list = html("dl", { class: "facts" });
    private readonly cells: { text: HTMLElement }[] = [];
    private document: Document | undefined;
    private wishes: Wishes | undefined;
    private moment: Moment | undefined;
    private listed = "";

    constructor() {
        this.element.append(html("div", { class: "row-of" }, this.what, this.vectors, this.trace), this.list);
        this.what.addEventListener("change", () => {
            const value = this.what.value;
            this.wishes?.change((wishes) => (wishes.chosen = value === "" ? undefined : Number(value)));
        });
        const switches = (of: HTMLElement, set: (wishes: Wishes) => Set<number>) => {
            of.addEventListener("click", () => {
                const point = this.point();
                if (point >= 0) this.wishes?.change((wishes) => toggle(set(wishes), point));
            });
        };
        switches(this.vectors, ({ vectorsAt }) => vectorsAt);
        switches(this.trace, ({ traced }) => traced);
    }

    show(document: Document, wishes: Wishes): void {
        if (!declareAlike(this.document, document)) {
            const all = document.scene.declarations.map(([name, kind], number): [string, string] => [String(number), `${kind} ${name}`]);
            fill(this.what, [NONE, ...all]);
        }
        [this.document, this.wishes] = [document, wishes];
        this.what.value = wishes.chosen === undefined ? "" : String(wishes.chosen);
        const point = this.point();
        for (const of of [this.vectors, this.trace]) of.hidden = point < 0;
        press(this.vectors, wishes.vectorsAt.has(point));
        press(this.trace, wishes.traced.has(point));
        if (this.moment) this.draw(this.moment);
    }

    draw(moment: Moment): void {
        this.moment = moment;
        const chosen = this.wishes?.chosen;
        const { facts } = chosen === undefined || !this.document ? { facts: [] } : factsOf(this.document, chosen, moment);
        const names = facts.map(({ name }) => name).join("\n");
        if (names !== this.listed) {
            this.listed = names;
            this.cells.length = 0;
            this.list.replaceChildren(
                ...facts.map(({ name }) => {
                    const text = html("dd", {});
                    this.cells.push({ text });
                    return html("div", {}, html("dt", {}, name), text);
                }),
            );
        }
        facts.forEach(({ text, si }, k) => {
            const cell = this.cells[k]!.text;
            cell.textContent = text;
            cell.title = si ?? text;
        });
    }

    private point(): number {
        const chosen = this.wishes?.chosen;
        return chosen === undefined ? -1 : (this.document?.scene.points.findIndex(({ declaration }) => declaration === chosen) ?? -1);
    }
}

function frameNames({ scene }: Document): [string, string][] {
    return scene.frames.map((declaration, frame) => [String(frame), scene.declarations[declaration]?.[0] ?? "ground"]);
}

/** Instant centres of two bodies, and their ways. */
class Poles implements Pane {
    readonly element = html("fieldset", {}, html("legend", {}, "Instant centre"));
    private readonly one = choice("of this body", [NONE]);
    private readonly other = choice("and of that body", [NONE]);
    private readonly curves = html("input", { type: "checkbox", checked: true });
    private readonly value = html("output", { class: "value" });
    private document: Document | undefined;
    private wishes: Wishes | undefined;

    constructor() {
        const both = html("label", {}, this.curves, " polodes");
        this.element.append(html("div", { class: "row-of" }, this.one, "and", this.other, both), this.value);
        for (const input of [this.one, this.other, this.curves]) {
            input.addEventListener("change", () => {
                const [one, other] = [this.one.value, this.other.value];
                const asked = one !== "" && other !== "" && one !== other;
                const pairing = { one: Number(one), other: Number(other), polodes: this.curves.checked };
                this.wishes?.change((wishes) => (wishes.pairing = asked ? pairing : undefined));
            });
        }
    }

    show(document: Document, wishes: Wishes): void {
        if (!declareAlike(this.document, document)) {
            for (const select of [this.one, this.other]) fill(select, [NONE, ...frameNames(document)]);
        }
        [this.document, this.wishes] = [document, wishes];
    }

    draw(moment: Moment): void {
        const pairing = this.wishes?.pairing;
        const at = pairing && pole(moment, pairing.one, pairing.other);
        this.value.hidden = !pairing;
        const told = (unit: LengthUnit) => at && ["x", "y"].map((name, k) => `${name} = ${withUnit(six(inUnit(at[k]!, unit)), unit.name)}`).join(", ");
        this.value.textContent = (this.document && told(lengthUnit(this.document.page))) ?? "at infinity: they do not turn against each other";
        this.value.title = at ? `${told(METRE)} (SI)` : "";
    }
}

/** The transmission angle at a pin. */
class Transmission implements Pane {
    readonly element = html("fieldset", {}, html("legend", {}, "Transmission angle"));
    private readonly pin = choice("at the pin", [NONE]);
    private readonly one = choice("from the direction to", [NONE]);
    private readonly other = choice("to the direction to", [NONE]);
    private readonly value = html("output", { class: "value" });
    private readonly plot = button("plot the transmission angle", "plot");
    private document: Document | undefined;
    private wishes: Wishes | undefined;
    private groups: number[][] = [];

    constructor(plot: (name: string) => void) {
        this.element.append(
            html("div", { class: "row-of" }, "at", this.pin),
            html("div", { class: "row-of" }, "between", this.one, "and", this.other),
            html("div", { class: "row-of" }, this.value, this.plot),
        );
        this.plot.addEventListener("click", () => plot(TRANSMISSION));
        this.pin.addEventListener("change", () => {
            this.fillDirections();
            this.choose();
        });
        for (const select of [this.one, this.other]) select.addEventListener("change", () => this.choose());
    }

    show(document: Document, wishes: Wishes): void {
        if (!declareAlike(this.document, document)) {
            this.document = document;
            this.groups = meetings(document.motion).filter((points) => this.linked(points).length === 2);
            const name = (points: number[]) => points.map((point) => document.scene.points[point]!.name).join(" = ");
            fill(this.pin, [NONE, ...this.groups.map((points, k): [string, string] => [String(k), name(points)])]);
            this.fillDirections();
        }
        [this.document, this.wishes] = [document, wishes];
        this.element.hidden = this.groups.length === 0;
        this.plot.hidden = !wishes.corner;
    }

    draw(moment: Moment): void {
        const corner = this.wishes?.corner;
        const places = corner && anchors(this.document!.scene, [corner.one, corner.pin, corner.other]);
        const angle = places && transmission(moment, ...(places as [Anchor, Anchor, Anchor]));
        this.value.textContent = angle === undefined ? "" : `μ = ${degrees(angle)}`;
        this.value.title = angle === undefined ? "" : `${six(angle)} rad (SI)`;
    }

    /** Two of the points at a pin: of moving frames that have other points. */
    private linked(points: number[]): number[] {
        const all = this.document!.scene.points;
        return points.filter((point) => all[point]!.frame > 0 && this.others(point).length > 0).slice(0, 2);
    }

    /** Points of the same frame, elsewhere. */
    private others(point: number): number[] {
        const all = this.document!.scene.points;
        const { frame, at } = all[point]!;
        return [...all.keys()].filter((k) => all[k]!.frame === frame && (all[k]!.at[0] !== at[0] || all[k]!.at[1] !== at[1]));
    }

    private fillDirections(): void {
        const points = this.document!.scene.points;
        const pins = this.groups[Number(this.pin.value)];
        const sides = this.pin.value === "" || !pins ? [] : this.linked(pins);
        [this.one, this.other].forEach((select, k) => {
            const side = sides[k];
            const others = side === undefined ? [] : this.others(side).sort((a, b) => Number(points[b]!.pin ?? false) - Number(points[a]!.pin ?? false));
            fill(select, others.length > 0 ? others.map((point) => [String(point), points[point]!.name]) : [NONE]);
        });
    }

    private choose(): void {
        const pins = this.groups[Number(this.pin.value)];
        const asked = this.pin.value !== "" && pins && this.one.value !== "" && this.other.value !== "";
        this.wishes?.change((wishes) => {
            const corner = asked && { one: Number(this.one.value), pin: this.linked(pins)[0]!, other: Number(this.other.value) };
            wishes.corner = corner || undefined;
        });
    }
}

/** A cam's pitch curve and pressure angle, where a joint has it touch what it moves. */
class Cam implements Pane {
    readonly element = html("fieldset", {}, html("legend", {}, "Pressure angle and pitch curve"));
    private readonly joint = choice("at the joint", [NONE]);
    private readonly value = html("output", { class: "value" });
    private readonly plot = button("plot the pressure angle", "plot");
    private document: Document | undefined;
    private wishes: Wishes | undefined;

    constructor(plot: (name: string) => void) {
        this.element.append(html("div", { class: "row-of" }, "at", this.joint), html("div", { class: "row-of" }, this.value, this.plot));
        this.plot.addEventListener("click", () => plot(PRESSURE));
        this.joint.addEventListener("change", () => {
            const { value } = this.joint;
            this.wishes?.change((wishes) => (wishes.contact = value === "" ? undefined : Number(value)));
        });
    }

    show(document: Document, wishes: Wishes): void {
        if (!declareAlike(this.document, document)) {
            const { contacts, declarations, frames } = document.scene;
            const name = (frame: number) => declarations[frames[frame]!]?.[0] ?? "ground";
            const entries = contacts.map(({ declaration, cam, follower }, k): [string, string] => {
                return [String(k), `${declarations[declaration]?.[0]}: ${name(cam)} moves ${name(follower)}`];
            });
            fill(this.joint, [NONE, ...entries]);
            this.element.hidden = entries.length === 0;
        }
        [this.document, this.wishes] = [document, wishes];
        this.joint.value = wishes.contact === undefined ? "" : String(wishes.contact);
        this.plot.hidden = wishes.contact === undefined;
    }

    draw(moment: Moment): void {
        const chosen = this.wishes?.contact;
        const contact = chosen === undefined ? undefined : this.document!.scene.contacts[chosen];
        const angle = contact && pressure(this.document!.motion, moment, contact);
        this.value.textContent = !contact ? "" : angle === undefined ? "the follower rests" : `α = ${degrees(angle)}`;
        if (angle !== undefined) this.value.title = `${six(angle)} rad (SI)`;
    }
}
