// What a program that runs has to say: that the text is wrong, that inputs do not go on, that it is not there.

import { button, html } from "../elements.ts";
import type { State } from "../live/transport.ts";

const STATES: Record<State, string> = {
    there: "",
    asleep: "mechc does not answer. The page goes on when it does.",
    gone: "mechc is not there any more, and what is shown follows nothing. Start it again, and open the address that it prints.",
    refused: "This address is not the one that mechc printed: the part behind “#” is missing or another one.",
};

/** Where messages lie below the picture, they are folded until a reader unfolds them. */
const WIDE = "(min-width: 62rem) and (min-height: 34rem)";

export class Said {
    readonly element = html("div", { class: "said", role: "status", "aria-live": "polite" });
    private readonly away = html("p", { class: "away", hidden: true });
    private readonly busy = html("p", { class: "working", hidden: true }, "working …");
    private readonly broken = new Folding("broken");
    private readonly stopped = new Folding("stopped");
    private readonly aside = html("p", { class: "aside", hidden: true });
    private readonly noted = html("p", { class: "noted", hidden: true });

    constructor() {
        this.element.append(this.away, this.busy, this.broken.element, this.stopped.element, this.aside, this.noted);
    }

    state(state: State): void {
        this.away.hidden = state === "there";
        if (this.away.textContent !== STATES[state]) this.away.textContent = STATES[state];
    }

    /** Whether an answer is being made that takes its time. */
    working(isSo: boolean): void {
        this.busy.hidden = !isSo;
    }

    /** What is wrong with the text, or with what is set, as it is printed; a picture of before may be there. */
    wrong(text: string, what: "the text" | "what is set", hasPicture: boolean): void {
        const head = what === "the text" ? "The text is wrong" : "It cannot be with what is set";
        this.broken.show(hasPicture ? `${head}; the picture is that of before.` : `${head}.`, text);
    }

    right(): void {
        this.broken.hide();
    }

    /** Why inputs do not go on; where that is said elsewhere, only when they do not. */
    jog(text: string | null, at = ""): void {
        if (text === null) this.stopped.hide();
        else this.stopped.show(text === "" ? `It does not get to ${at} with what is set.` : "It does not go on.", text);
    }

    /** What is set and has no place in the text. */
    kept(text: string): void {
        this.aside.hidden = text === "";
        if (this.aside.textContent !== text) this.aside.textContent = text;
    }

    /** What became of something that was done, until its reader has read it. */
    note(text: string): void {
        this.noted.hidden = text === "";
        const close = button("close", "×", { class: "close" });
        close.addEventListener("click", () => this.note(""));
        this.noted.replaceChildren(text, close);
    }
}

/** A message of which only the first line stays when it is folded. */
class Folding {
    readonly element: HTMLElement;
    private readonly details = html("details", {});

    constructor(what: string) {
        this.details.open = matchMedia(WIDE).matches;
        this.element = html("section", { class: what, hidden: true }, this.details);
    }

    show(head: string, text: string): void {
        this.element.hidden = false;
        this.details.replaceChildren(html("summary", {}, html("strong", {}, head)), ...(text ? [printed(text)] : []));
    }

    hide(): void {
        this.element.hidden = true;
    }
}

/** Lines that quote the text, or stand below it: their columns mean something. */
const QUOTING = /^\s*\d*\s*[┌│·]/;
/** What is said of a place stands behind what marks it. */
const MARKED = /^(\s*│\s*[\^-]+\s+)\S/;

/** Words are broken where the room ends, quoted lines are not; what is wider than the page is reached by keys too. */
function printed(text: string): HTMLElement {
    const lines = text.trimEnd().split(/(?<=\n)/);
    const shown = lines.map((line) => {
        const mark = MARKED.exec(line);
        if (!mark) return html("span", { class: QUOTING.test(line) ? "quoting" : undefined }, line);
        // what is said goes on below its begin
        const said = html("span", { class: "marking" }, html("span", { class: "mark-of" }, mark[1]!), html("span", {}, line.slice(mark[1]!.length)));
        return said;
    });
    return html("pre", { tabindex: 0, role: "region", "aria-label": "as mechc run prints it" }, ...shown);
}
