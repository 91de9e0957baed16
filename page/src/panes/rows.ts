// The rows as a table: what is plotted, in numbers.

import type { Document } from "../data/document.ts";
import { printed } from "../data/table.ts";
import { button, html, sign } from "../elements.ts";
import type { Moment } from "../motion/motion.ts";
import { set, siUnit, six } from "../numbers.ts";
import type { Deeds, Pane } from "./pane.ts";

/** So many rows at once. */
const PAGE = 20;

export class Rows implements Pane {
    readonly element = html("section", { class: "pane rows", "aria-label": "table" });
    private readonly head = html("tr");
    private readonly body = html("tbody");
    private readonly where = html("span", { role: "status" });
    private document: Document | undefined;
    private isOld = true;
    private first = 0;
    private now = -1;

    constructor(
        private readonly plotted: () => string[],
        private readonly deeds: Deeds,
    ) {
        const back = button("earlier rows", sign("M15 5l-8 7 8 7"));
        const on = button("later rows", sign("M9 5l8 7-8 7"));
        const here = button("now: the rows at this time", "now");
        const turn = (to: () => number) => () => {
            this.first = Math.max(0, Math.min(to(), (this.document?.table.rows ?? 0) - 1));
            this.fill();
        };
        back.addEventListener("click", turn(() => this.first - PAGE));
        on.addEventListener("click", turn(() => (this.first + PAGE < (this.document?.table.rows ?? 0) ? this.first + PAGE : this.first)));
        here.addEventListener("click", turn(() => this.now - PAGE / 2));
        const table = html("table", {}, html("caption", {}, "what is plotted, row by row"), html("thead", {}, this.head), this.body);
        const sheet = html("div", { class: "sheet", tabindex: 0, role: "region", "aria-label": "rows" }, table);
        this.element.append(html("div", { class: "row-of" }, back, on, here, this.where), sheet);
    }

    show(document: Document): void {
        if (this.document === document) return;
        this.document = document;
        this.first = 0;
        this.isOld = true;
    }

    draw({ row }: Moment): void {
        // rows that nobody sees are not written
        if (this.isOld && !this.element.classList.contains("behind")) this.fill();
        if (row === this.now) return;
        this.body.querySelector(".current")?.classList.remove("current");
        this.now = row;
        this.body.children[row - this.first]?.classList.add("current");
    }

    /** Other columns are plotted. */
    plottedAnew(): void {
        this.isOld = true;
        if (!this.element.classList.contains("behind")) this.fill();
    }

    fill(): void {
        if (!this.document) return;
        this.isOld = false;
        const { table } = this.document;
        const places = [...new Set(["t", ...this.plotted()])].flatMap((name) => table.place(name) ?? []);
        const columns = places.map((place) => ({ column: table.columns[place]!, values: table.values[place]! }));
        this.head.replaceChildren(
            ...columns.map(({ column: { name, unit } }) => html("th", { scope: "col" }, name, html("small", {}, set(unit)))),
        );
        const last = Math.min(this.first + PAGE, table.rows);
        const rows = Array.from({ length: Math.max(0, last - this.first) }, (_, k) => this.first + k);
        this.body.replaceChildren(
            ...rows.map((row) => {
                const cells = columns.map(({ column, values }) => {
                    const si = `${six(values[row]!)} ${set(column.scale ? siUnit(column.unit) : column.unit)} (SI)`;
                    return html("td", { title: si }, six(printed(column, values[row]!)));
                });
                const made = html("tr", row === this.now ? { class: "current" } : {}, ...cells);
                made.addEventListener("click", () => {
                    this.deeds.pause();
                    void this.deeds.seek(table.times[row]!);
                });
                return made;
            }),
        );
        this.where.textContent = table.rows > 0 ? `rows ${this.first + 1} to ${last} of ${table.rows}` : "no rows";
    }
}
