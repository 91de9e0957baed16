// Panes of which one is seen at a time; all of them are printed that belong on paper.

import { html } from "../elements.ts";

let made = 0;

export class Tabs {
    readonly element = html("div", { class: "tabbed" });
    private readonly heads: HTMLButtonElement[];

    constructor(
        private readonly entries: readonly [name: string, pane: HTMLElement][],
        private readonly turned: () => void,
    ) {
        this.heads = entries.map(([name, pane], number) => {
            pane.id = `pane-${made++}`;
            pane.setAttribute("role", "tabpanel");
            const head = html("button", { type: "button", role: "tab", "aria-controls": pane.id }, name);
            head.addEventListener("click", () => this.turnTo(number));
            head.addEventListener("keydown", (event) => {
                const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
                if (by === 0) return;
                event.preventDefault();
                const next = (number + by + entries.length) % entries.length;
                this.turnTo(next);
                this.heads[next]!.focus();
            });
            return head;
        });
        const list = html("div", { class: "tabs", role: "tablist", "aria-label": "panes" }, ...this.heads);
        this.element.append(list, ...entries.map(([, pane]) => pane));
        this.turnTo(0);
    }

    turnTo(number: number): void {
        this.entries.forEach(([, pane], k) => pane.classList.toggle("behind", k !== number));
        this.heads.forEach((head, k) => {
            head.setAttribute("aria-selected", String(k === number));
            head.tabIndex = k === number ? 0 : -1;
        });
        this.turned();
    }
}
