// Numbers for the whole motion, and what there is to say of it.

import type { Document } from "../data/document.ts";
import type { Message } from "../data/format.ts";
import { html } from "../elements.ts";
import type { Moment } from "../motion/motion.ts";
import { six, told } from "../numbers.ts";
import type { Deeds, Pane } from "./pane.ts";

export class Results implements Pane {
    readonly element = html("section", { class: "results", "aria-label": "results and messages", tabindex: 0 });
    private readonly numbers = html("dl", { class: "numbers" });
    private readonly messages = html("ul", { class: "messages" });
    private document: Document | undefined;

    constructor(private readonly deeds: Deeds) {
        this.element.append(html("div", { role: "status", "aria-live": "polite" }, this.messages), this.numbers);
    }

    show(document: Document): void {
        if (this.document === document) return;
        this.document = document;
        const { results, messages, page, table } = document;
        this.numbers.replaceChildren(
            ...results.map((result) => {
                const { text, si } = told(result, result.value ?? NaN);
                return html("div", {}, html("dt", {}, result.name), html("dd", { title: si }, text));
            }),
        );
        this.numbers.hidden = results.length === 0;
        const said = messages.map((message) => this.written(message, table.rows > 1));
        if (page.thinned) said.push(html("li", { class: "note-of-page" }, page.thinned));
        this.messages.replaceChildren(...said);
        this.messages.hidden = said.length === 0;
        this.element.hidden = said.length === 0 && results.length === 0;
    }

    draw(_: Moment): void {}

    private written({ severity, code, text, labels, notes, help, time }: Message, moves: boolean): HTMLElement {
        const item = html("li", { class: `message ${severity}` }, html("strong", {}, `${severity}[${code}]`), ` ${text}`);
        for (const { says } of labels ?? []) if (says) item.append(html("div", {}, says));
        // a note of several lines is a table
        for (const note of notes ?? []) item.append(html(note.includes("\n") ? "pre" : "div", {}, note));
        for (const says of help ?? []) item.append(html("div", { class: "help" }, `help: ${says}`));
        if (time !== undefined && moves) {
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
