// The text of the mechanism: declarations light what is drawn of them, and the reverse.

import { declareAlike, type Document } from "../data/document.ts";
import type { Declaration } from "../data/format.ts";
import { html } from "../elements.ts";
import type { Moment } from "../motion/motion.ts";
import type { Wishes } from "../wishes.ts";
import type { Pane } from "./pane.ts";

/** A stretch of a text that declares something: several things, where it declares a row of them. */
interface Stretch {
    from: number;
    to: number;
    declarations: number[];
}

export class Text implements Pane {
    readonly element = html("section", { class: "pane text", "aria-label": "the text" });
    private readonly tabs = html("div", { class: "tabs", role: "tablist", "aria-label": "files" });
    private readonly sheet = html("div", { class: "sheet", tabindex: 0, role: "region", "aria-label": "text of the mechanism" });
    private document: Document | undefined;
    private readonly paper = html("div", { class: "paper" });
    private texts: Document["page"]["texts"] | undefined;
    private declarations: readonly Declaration[] = [];
    private readonly marked = new Map<number, HTMLElement>();
    private lit: HTMLElement[] = [];
    private shown = 0;
    private wishes: Wishes | undefined;
    private chosen: number | undefined;

    constructor() {
        this.element.append(this.tabs, this.sheet, this.paper);
        const declared = (event: Event) => {
            const mark = event.target instanceof Element ? event.target.closest("[data-declared]") : null;
            return mark ? mark.getAttribute("data-declared")!.split(" ").map(Number) : [];
        };
        this.sheet.addEventListener("pointerover", (event) => {
            this.wishes?.point(declared(event));
        });
        this.sheet.addEventListener("pointerleave", () => this.wishes?.point([]));
        this.sheet.addEventListener("click", (event) => {
            const [first] = declared(event);
            if (getSelection()?.isCollapsed === false) return;
            this.wishes?.change((wishes) => (wishes.chosen = first === wishes.chosen ? undefined : first));
        });
    }

    show(document: Document, wishes: Wishes): void {
        this.wishes = wishes;
        const { page, scene } = document;
        const isNew = this.document !== document;
        const alike = sameTexts(this.texts, page.texts) && declareAlike(this.document, document);
        this.document = document;
        if (!alike) {
            [this.texts, this.declarations] = [page.texts, scene.declarations];
            this.lay();
        }
        if (wishes.chosen !== this.chosen) {
            this.chosen = wishes.chosen;
            const text = wishes.chosen === undefined ? undefined : scene.declarations[wishes.chosen]?.[2];
            if (text !== undefined && text !== this.shown && text < page.texts.length) {
                this.shown = text;
                this.lay();
            }
            if (wishes.chosen !== undefined) this.bring(this.marked.get(wishes.chosen));
        }
        this.blame();
        if (isNew) this.bringBlamed();
        this.light(wishes);
    }

    light(wishes: Wishes): void {
        for (const mark of this.lit) mark.classList.remove("lit", "chosen");
        const marks = (numbers: readonly number[], name: string) => {
            return numbers.flatMap((number) => {
                const mark = this.marked.get(number);
                mark?.classList.add(name);
                return mark ? [mark] : [];
            });
        };
        this.lit = [...marks(wishes.pointed, "lit"), ...marks(wishes.chosen === undefined ? [] : [wishes.chosen], "chosen")];
    }

    draw(_: Moment): void {}

    /** Marks what errors name. */
    private blame(): void {
        const named = new Set(this.document?.named);
        for (const [declaration, mark] of this.marked) if (!named.has(declaration)) mark.classList.remove("wrong");
        for (const declaration of named) this.marked.get(declaration)?.classList.add("wrong");
    }

    /** Brings the first place that errors name into sight. */
    private bringBlamed(): void {
        const places = (this.document?.named ?? []).flatMap((declaration) => {
            const declared = this.declarations[declaration];
            return declared && declared[4] > declared[3] ? [{ declaration, text: declared[2], from: declared[3] }] : [];
        });
        places.sort((a, b) => a.text - b.text || a.from - b.from);
        const [first] = places;
        if (!first) return;
        if (!places.some(({ text }) => text === this.shown)) this.turnTo(first.text);
        const here = places.find(({ text }) => text === this.shown);
        this.bring(here && this.marked.get(here.declaration));
    }

    /** The other texts, for paper. */
    print(): void {
        const others = (this.texts ?? []).filter((_, number) => number !== this.shown);
        this.paper.replaceChildren(
            ...others.flatMap(({ name, text }) => [html("h2", {}, name), html("pre", { class: "plain" }, ...coloured(text))]),
        );
    }

    private lay(): void {
        const texts = this.texts!;
        this.tabs.hidden = texts.length < 2;
        this.tabs.replaceChildren(
            ...texts.map(({ name }, number) => {
                const tab = html("button", { type: "button", role: "tab", "aria-selected": String(number === this.shown) }, name);
                if (number !== this.shown) tab.tabIndex = -1;
                tab.addEventListener("click", () => this.turnTo(number));
                tab.addEventListener("keydown", (event) => {
                    const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
                    if (by === 0) return;
                    event.stopPropagation();
                    this.turnTo((this.shown + by + texts.length) % texts.length);
                    (this.tabs.children[this.shown] as HTMLElement).focus();
                });
                return tab;
            }),
        );
        this.marked.clear();
        const text = texts[this.shown]?.text ?? "";
        const lines = text.split("\n").length - (text.endsWith("\n") ? 1 : 0);
        const numbers = html("pre", { class: "lines", "aria-hidden": "true" }, Array.from({ length: lines }, (_, k) => k + 1).join("\n"));
        const code = html("code", {});
        this.write(code, text, this.stretches());
        this.sheet.replaceChildren(numbers, html("pre", { class: "source" }, code));
    }

    private turnTo(text: number): void {
        this.shown = text;
        this.lay();
        this.blame();
    }

    /** What is declared in the text that is shown, outer stretches first. */
    private stretches(): Stretch[] {
        const stretches = new Map<string, Stretch>();
        this.declarations.forEach(([, , text, from, to], number) => {
            if (text !== this.shown || to <= from) return;
            const key = `${from} ${to}`;
            const same = stretches.get(key);
            if (same) same.declarations.push(number);
            else stretches.set(key, { from, to, declarations: [number] });
        });
        return [...stretches.values()].sort((a, b) => a.from - b.from || b.to - a.to);
    }

    private write(code: HTMLElement, text: string, stretches: Stretch[]): void {
        const open: { mark: HTMLElement; to: number }[] = [{ mark: code, to: text.length }];
        let at = 0;
        const upTo = (end: number) => {
            if (end > at) open[open.length - 1]!.mark.append(...coloured(text.slice(at, end)));
            at = Math.max(at, end);
        };
        const close = (until: number) => {
            while (open.length > 1 && open[open.length - 1]!.to <= until) {
                upTo(open[open.length - 1]!.to);
                open.pop();
            }
        };
        for (const { from, to, declarations } of stretches) {
            close(from);
            // one that laps over the end of another cannot be an element
            if (from < at || to > open[open.length - 1]!.to) continue;
            upTo(from);
            const mark = html("span", { class: "declared", "data-declared": declarations.join(" ") });
            for (const declaration of declarations) this.marked.set(declaration, mark);
            open[open.length - 1]!.mark.append(mark);
            open.push({ mark, to });
        }
        close(text.length);
        upTo(text.length);
    }

    /** Scrolls a mark into the sheet, and nothing else. */
    private bring(mark: HTMLElement | undefined): void {
        if (!mark) return;
        const [sheet, at] = [this.sheet.getBoundingClientRect(), mark.getBoundingClientRect()];
        if (at.top < sheet.top || at.bottom > sheet.bottom) this.sheet.scrollTop += at.top - sheet.top - sheet.height / 3;
    }
}

function sameTexts(one: Document["page"]["texts"] | undefined, other: Document["page"]["texts"]): boolean {
    return one === other || (one?.length === other.length && one.every(({ name, text }, k) => name === other[k]!.name && text === other[k]!.text));
}

const TOKEN = /(\/\/[^\n]*)|\b(\d[\d.]*(?:[eE][-+]?\d+)?)\b|(?<=^|\n|\{)([ \t]*)([a-z]+)\b|("[^"\n]*")/g;

/** The text in pieces: comments, numbers, first words. */
function coloured(text: string): (string | HTMLElement)[] {
    const pieces: (string | HTMLElement)[] = [];
    let at = 0;
    for (const match of text.matchAll(TOKEN)) {
        const [all, comment, number, indent, word] = match;
        const skip = indent?.length ?? 0;
        pieces.push(text.slice(at, match.index + skip));
        const name = comment ? "comment" : number ? "number" : word ? "word" : "string";
        pieces.push(html("span", { class: name }, all.slice(skip)));
        at = match.index + all.length;
    }
    pieces.push(text.slice(at));
    return pieces.filter((piece) => piece !== "");
}
