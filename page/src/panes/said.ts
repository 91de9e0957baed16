// What a program that runs has to say: that the text is wrong, that inputs do not go on, that it is not there.

import { html } from "../elements.ts";
import type { State } from "../live/transport.ts";

const STATES: Record<State, string> = {
    there: "",
    asleep: "mechc does not answer. The page goes on when it does.",
    gone: "mechc is not there any more, and what is shown follows nothing. Start it again, and open the address that it prints.",
    refused: "This address is not the one that mechc printed: the part behind “#” is missing or another one.",
};

export class Said {
    readonly element = html("div", { class: "said", role: "status", "aria-live": "polite" });
    private readonly away = html("p", { class: "away", hidden: true });
    private readonly broken = html("section", { class: "broken", hidden: true });
    private readonly stopped = html("section", { class: "stopped", hidden: true });

    constructor() {
        this.element.append(this.away, this.broken, this.stopped);
    }

    state(state: State): void {
        this.away.hidden = state === "there";
        if (this.away.textContent !== STATES[state]) this.away.textContent = STATES[state];
    }

    /** What is wrong with the text, or with what is set, as it is printed; a picture of before may be there. */
    wrong(text: string, what: "the text" | "what is set", hasPicture: boolean): void {
        this.broken.hidden = false;
        const head = what === "the text" ? "The text is wrong" : "It cannot be with what is set";
        this.broken.replaceChildren(html("strong", {}, hasPicture ? `${head}; the picture is that of before.` : `${head}.`), printed(text));
    }

    right(): void {
        this.broken.hidden = true;
    }

    /** Why inputs do not go on. */
    jog(text: string | null): void {
        this.stopped.hidden = text === null;
        if (text !== null) this.stopped.replaceChildren(html("strong", {}, "It does not go on."), printed(text));
    }
}

/** Lines that quote the text, or stand below it: their columns mean something. */
const QUOTING = /^\s*\d*\s*[┌│·]/;

/** Words are broken where the room ends, quoted lines are not; what is wider than the page is reached by keys too. */
function printed(text: string): HTMLElement {
    const lines = text.trimEnd().split(/(?<=\n)/);
    const shown = lines.map((line) => html("span", { class: QUOTING.test(line) ? "quoting" : undefined }, line));
    return html("pre", { tabindex: 0, role: "region", "aria-label": "as mechc run prints it" }, ...shown);
}
