// Numbers for the whole motion, and what there is to say of it.

import type { Document } from "../data/document.ts";
import type { Label, Message, Page } from "../data/format.ts";
import { html } from "../elements.ts";
import type { Moment } from "../motion/motion.ts";
import { six, told } from "../numbers.ts";
import type { Deeds, Pane } from "./pane.ts";

export class Results implements Pane {
    readonly element = html("section", { class: "results", "aria-label": "results and messages", tabindex: 0 });
    private readonly numbers = html("dl", { class: "numbers" });
    private readonly messages = html("ul", { class: "messages" });
    private document: Document | undefined;
    private hasRoom = false;

    constructor(private readonly deeds: Deeds) {
        this.element.append(html("div", { role: "status", "aria-live": "polite" }, this.messages), this.numbers);
    }

    /** Whether it takes the same room with messages and without. */
    keepRoom(keeps: boolean): void {
        this.hasRoom = keeps;
        this.element.classList.toggle("kept", keeps);
    }

    show(document: Document): void {
        if (this.document === document) return;
        this.document = document;
        const { results, messages, page } = document;
        this.numbers.replaceChildren(
            ...results.map((result) => {
                const { text, si } = told(result, result.value ?? NaN);
                return html("div", {}, html("dt", {}, result.name), html("dd", { title: si }, text));
            }),
        );
        this.numbers.hidden = results.length === 0;
        const said = messages.map((message) => this.written(message, document));
        if (page.thinned) said.push(html("li", { class: "note-of-page" }, page.thinned));
        this.messages.replaceChildren(...said);
        this.messages.hidden = said.length === 0;
        this.element.hidden = said.length === 0 && results.length === 0 && !this.hasRoom;
    }

    draw(_: Moment): void {}

    private written({ severity, code, text, labels, notes, help, time }: Message, { page, table }: Document): HTMLElement {
        const item = html("li", { class: `message ${severity}` }, html("strong", {}, `${severity}[${code}]`), ` ${text}`);
        for (const { names, says } of saidOf(labels ?? [], page)) item.append(html("div", {}, html("code", {}, names.join(", ")), ` ${says}`));
        // a note of several lines is a table
        for (const note of notes ?? []) item.append(html(note.includes("\n") ? "pre" : "div", {}, note));
        for (const says of help ?? []) item.append(html("div", { class: "help" }, `help: ${says}`));
        if (time !== undefined && table.rows > 1) {
            const there = html("button", { type: "button" }, `go to t = ${six(time)} s`);
            there.addEventListener("click", () => {
                this.deeds.pause();
                void this.deeds.seek(time);
            });
            item.append(there);
        }
        return item;
    }
}

/** No more of a text than this stands for a place of it. */
const LONGEST = 40;

/** What is said of places, each with what is there; a place of which nothing is said is one of those before it. */
function saidOf(labels: readonly Label[], { texts }: Page): { names: string[]; says: string }[] {
    const told: { names: string[]; says: string }[] = [];
    for (const { text, from, to, says } of labels) {
        const there = (texts[text]?.text.slice(from, to) ?? "").trim();
        const name = there.length > LONGEST ? `${there.slice(0, LONGEST - 1)}…` : there;
        const last = told[told.length - 1];
        if (says || !last) told.push({ names: [name], says });
        else last.names.push(name);
    }
    return told;
}
