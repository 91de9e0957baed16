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

    /** What is wrong with the text, as it is printed; a picture of before may be there. */
    wrong(text: string | undefined, hasPicture: boolean): void {
        this.broken.hidden = text === undefined;
        if (text === undefined) return;
        const head = hasPicture ? "The text is wrong; the picture is that of before." : "The text is wrong.";
        this.broken.replaceChildren(html("strong", {}, head), printed(text));
    }

    /** Why inputs do not go on. */
    jog(text: string | null): void {
        this.stopped.hidden = text === null;
        if (text !== null) this.stopped.replaceChildren(html("strong", {}, "It does not go on."), printed(text));
    }
}

/** What is wider than the page is reached by keys too. */
function printed(text: string): HTMLElement {
    return html("pre", { tabindex: 0, role: "region", "aria-label": "as mechc run prints it" }, text.trimEnd());
}
