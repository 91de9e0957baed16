// Plots: of all measures at first, and of any column over any other. Where time is, can be taken in each.

import uPlot from "uplot";
import type { Document } from "../data/document.ts";
import { button, fill, html, sign } from "../elements.ts";
import type { Moment, Pair } from "../motion/motion.ts";
import { set, short, six, withUnit } from "../numbers.ts";
import type { Wishes } from "../wishes.ts";
import type { Deeds, Pane } from "./pane.ts";
import { plotted } from "./plotted.ts";
import { around, entries, measured, seriesOf, ticks, type Series } from "./series.ts";

/** So many plots are made at first, at the most. */
const AT_FIRST = 6;
/** From one tick to the next, across and up, in letters' sizes. */
const [ACROSS, UP] = [5.5, 2.4];
/** A plot's height, in lines of text. */
const HEIGHT = 8;

export class Plots implements Pane {
    readonly element = html("section", { class: "pane plots", "aria-label": "plots" });
    private readonly list = html("div", { class: "plot-list", tabindex: 0, role: "region", "aria-label": "list of plots" });
    private readonly plots: Plot[] = [];
    private document: Document | undefined;
    private wishes: Wishes | undefined;
    private moment: Moment | undefined;
    private standing: Document | undefined;
    private readonly empty = html("p", { class: "empty" });
    /** Whether there was a motion yet, whose measures are plotted. */
    private hasBegun = false;
    private onPlotted: () => void = () => {};

    constructor(private readonly deeds: Deeds) {
        const more = button("add a plot", sign("M12 5v14M5 12h14"));
        more.addEventListener("click", () => this.addFor());
        this.element.append(html("header", {}, html("h2", {}, "Plots"), more), this.empty, this.list);
        new ResizeObserver(() => this.plots.forEach((plot) => plot.fit())).observe(this.list);
        const again = () => this.plots.forEach((plot) => plot.make());
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
    }

    /** What is plotted, the columns of each once. */
    get plotted(): string[] {
        return [...new Set(this.plots.flatMap(({ x, y }) => [x, y]))];
    }

    whenPlotted(tell: () => void): void {
        this.onPlotted = tell;
    }

    /** Adds a plot, or brings it to sight where there is one. */
    add(y: string, x = "t"): void {
        const same = this.plots.find((plot) => plot.y === y && plot.x === x);
        const plot = same ?? new Plot(x, y, this.deeds, (plot) => this.remove(plot), () => this.onPlotted());
        if (!same) {
            this.plots.push(plot);
            this.list.append(plot.element);
            plot.standing = this.standing;
            if (this.document && this.wishes) plot.show(this.document, this.wishes);
            if (this.moment) plot.draw(this.moment);
            this.tellEmpty();
            this.onPlotted();
        }
    }

    show(document: Document, wishes: Wishes): void {
        [this.document, this.wishes] = [document, wishes];
        for (const plot of this.plots) plot.show(document, wishes);
        if (!this.hasBegun && document.table.rows > 1) {
            this.hasBegun = true;
            for (const name of this.atFirst(document)) this.add(name);
        }
        this.tellEmpty();
    }

    /** Says why there is no plot. */
    private tellEmpty(): void {
        const moves = (this.document?.table.rows ?? 0) > 1;
        this.empty.textContent = moves ? "There is no plot: + adds one, of any column." : "There is no motion, and so there is nothing to plot.";
        this.empty.hidden = this.plots.length > 0;
    }

    /** Where inputs that are moved by hand have brought everything, which is none of the rows. */
    stand(at: Document | undefined): void {
        this.standing = at;
        for (const plot of this.plots) plot.standing = at;
    }

    draw(moment: Moment): void {
        this.moment = moment;
        for (const plot of this.plots) plot.draw(moment);
    }

    /** Drawings of all plots for print. */
    print(): void {
        for (const plot of this.plots) plot.print();
    }

    private atFirst(document: Document): string[] {
        const all = measured(document);
        const first = document.table.columns.find(({ name }) => name.endsWith(".phi"))?.name;
        return all.length > 0 ? all.slice(0, AT_FIRST) : first ? [first] : [];
    }

    private addFor(): void {
        if (!this.document) return;
        const shown = new Set(this.plots.map(({ y }) => y));
        const names = [...measured(this.document), ...this.document.table.columns.slice(1).map(({ name }) => name)];
        const next = names.find((name) => !shown.has(name));
        if (!next) return;
        this.add(next);
        this.list.lastElementChild?.scrollIntoView({ block: "nearest" });
    }

    private remove(plot: Plot): void {
        this.plots.splice(this.plots.indexOf(plot), 1);
        plot.element.remove();
        this.tellEmpty();
        this.onPlotted();
    }
}

class Plot {
    readonly element = html("figure", { class: "plot" });
    private readonly chooseY = html("select", { "aria-label": "what is plotted" });
    private readonly chooseX = html("select", { "aria-label": "over what" });
    private readonly value = html("output", { class: "value", "aria-live": "off" });
    private readonly area = html("div", { class: "area", role: "img" });
    private readonly paper = html("div", { class: "paper" });
    private readonly line = html("div", { class: "now-line" });
    private readonly dot = html("div", { class: "now-dot" });
    private chart: uPlot | undefined;
    private document: Document | undefined;
    private wishes: Wishes | undefined;
    private series: [Series, Series] | undefined;
    private moment: Moment | undefined;
    /** What is shown of now, where that is no row of the motion. */
    standing: Document | undefined;

    constructor(
        public x: string,
        public y: string,
        private readonly deeds: Deeds,
        remove: (plot: Plot) => void,
        changed: () => void,
    ) {
        const close = button("remove the plot", sign("M6 6l12 12M18 6L6 18"));
        close.addEventListener("click", () => remove(this));
        const head = html("figcaption", {}, this.chooseY, html("span", { class: "over-what" }, "over"), this.chooseX, this.value, close);
        this.element.append(head, this.area, this.paper);
        const all = (select: HTMLSelectElement) => {
            // thousands of columns are listed when they are asked for
            const list = () => this.document && this.wishes && fill(select, entries(this.document, this.wishes));
            select.addEventListener("focus", list, { once: true });
            select.addEventListener("pointerdown", list, { once: true });
            select.addEventListener("change", () => {
                [this.x, this.y] = [this.chooseX.value, this.chooseY.value];
                this.make();
                changed();
            });
        };
        this.value.addEventListener("pointerenter", () => {
            if (this.moment) this.value.title = this.now()?.[1].si(this.moment) ?? "";
        });
        all(this.chooseX);
        all(this.chooseY);
        this.scrubs();
    }

    show(document: Document, wishes: Wishes): void {
        const same = this.document === document && this.series !== undefined && document.table.place(this.y) !== undefined;
        const isNew = this.document !== document;
        [this.document, this.wishes] = [document, wishes];
        if (same) return;
        const named = this.chart && isNew ? this.named() : undefined;
        if (named) this.renew(named);
        else this.make();
    }

    private named(document = this.document!): [Series, Series] | undefined {
        const [x, y] = [this.x, this.y].map((name) => seriesOf(document, this.wishes!, name));
        return x && y && [x, y];
    }

    /** The series of what is shown of now. */
    private now(): [Series, Series] | undefined {
        return this.standing && this.wishes ? this.named(this.standing) : this.series;
    }

    /** Other numbers in the same chart. */
    private renew(series: [Series, Series]): void {
        const units = (of: [Series, Series]) => of.map(({ unit }) => unit).join();
        if (!this.chart || !this.series || units(this.series) !== units(series)) return this.make();
        this.series = series;
        this.area.setAttribute("aria-label", inWords(...series));
        // at once, rather than after what is drawn next
        const { chart } = this;
        chart.batch(() => chart.setData(dataOf(...series)));
        if (this.moment) this.draw(this.moment);
    }

    /** The chart anew: other data, other colours. */
    make(): void {
        if (!this.document || !this.wishes) return;
        for (const [select, name] of [[this.chooseX, this.x], [this.chooseY, this.y]] as const) {
            if (![...select.options].some(({ value }) => value === name)) fill(select, [[name, name]]);
            select.value = name;
        }
        this.chart?.destroy();
        this.chart = undefined;
        this.series = this.named();
        const [x, y] = this.series ?? [];
        this.element.setAttribute("data-column", this.y);
        this.area.setAttribute("aria-label", x && y ? inWords(x, y) : `${this.y}: not there`);
        if (!x || !y || this.area.clientWidth === 0) return;
        this.chart = chart(() => this.series!, this.area, this.size());
        this.chart.over.append(this.line, this.dot);
        if (this.moment) this.draw(this.moment);
    }

    fit(): void {
        if (!this.chart) this.make();
        else if (this.chart.width !== this.size().width || this.chart.height !== this.size().height) {
            const { chart } = this;
            chart.batch(() => chart.setSize(this.size()));
            if (this.moment) this.draw(this.moment);
        }
    }

    draw(moment: Moment): void {
        this.moment = moment;
        const now = this.now();
        if (!now || !this.chart) return;
        const [x, y] = now.map((series) => series.at(moment)) as Pair;
        this.value.textContent = withUnit(six(y), now[1].unit);
        // nobody hovers over what is not under the pointer
        if (this.value.matches(":hover")) this.value.title = now[1].si(moment);
        const [left, top] = [this.chart.valToPos(x, "x"), this.chart.valToPos(y, "y")];
        this.line.style.transform = `translateX(${left}px)`;
        this.line.hidden = !Number.isFinite(left) || this.x !== "t";
        this.dot.style.transform = `translate(${left}px, ${top}px)`;
        this.dot.hidden = !Number.isFinite(left + top);
    }

    print(): void {
        if (this.series) this.paper.replaceChildren(plotted(...this.series));
    }

    private size(): { width: number; height: number } {
        const line = parseFloat(getComputedStyle(document.documentElement).fontSize);
        return { width: Math.floor(this.area.clientWidth), height: Math.round(HEIGHT * line) };
    }

    private scrubs(): void {
        const take = (event: PointerEvent) => {
            const { chart, series } = this;
            if (!chart || !series || event.buttons !== 1) return;
            const { left, top } = chart.over.getBoundingClientRect();
            const [x, y] = [event.clientX - left, event.clientY - top];
            this.deeds.pause();
            void this.deeds.seek(this.x === "t" ? chart.posToVal(x, "x") : this.nearest(chart, [x, y]));
        };
        this.area.addEventListener("pointerdown", (event) => {
            this.area.setPointerCapture(event.pointerId);
            take(event);
        });
        this.area.addEventListener("pointermove", take);
    }

    /** The time of the row that is drawn nearest to a pixel. */
    private nearest(chart: uPlot, [x, y]: Pair): number {
        const [xs, ys] = this.series!.map(({ values }) => values) as [Float64Array, Float64Array];
        let [least, row] = [Infinity, 0];
        for (let k = 0; k < xs.length; k++) {
            const away = Math.hypot(chart.valToPos(xs[k]!, "x") - x, chart.valToPos(ys[k]!, "y") - y);
            if (away < least) [least, row] = [away, k];
        }
        return this.document!.table.times[row] ?? 0;
    }
}

/** What a plot shows, for those who hear it. */
function inWords(x: Series, y: Series): string {
    const range = ({ values }: Series) => {
        const known = values.filter(Number.isFinite);
        if (known.length === 0) return "without a value";
        return `from ${short(Math.min(...known))} to ${short(Math.max(...known))}`;
    };
    const name = ({ name, unit }: Series) => (set(unit) ? `${name} (${set(unit)})` : name);
    return `${name(y)} ${range(y)}, over ${name(x)} ${range(x)}`;
}

/** What a chart is given: the numbers over time; over anything else only their ends, for the curve is drawn by itself. */
function dataOf(x: Series, y: Series): uPlot.AlignedData {
    if (x.name !== "t") return [ends(x), ends(y)];
    return [Array.from(x.values), Array.from(y.values, (value) => (Number.isFinite(value) ? value : null))];
}

function ends({ values }: Series): Pair {
    const known = values.filter(Number.isFinite);
    return known.length > 0 ? around(Math.min(...known), Math.max(...known)) : [0, 1];
}

function chart(shown: () => [Series, Series], into: HTMLElement, size: { width: number; height: number }): uPlot {
    const [x, y] = shown();
    const style = getComputedStyle(into);
    const colour = (name: string) => style.getPropertyValue(name).trim();
    // of a broken number uPlot reads what is behind the point
    const font = `${Math.round(parseFloat(style.fontSize))}px ${style.fontFamily}`;
    const line = parseFloat(style.fontSize);
    const isTime = x.name === "t";
    const axis = (more: Partial<uPlot.Axis>): uPlot.Axis => ({
        stroke: colour("--quiet"),
        font,
        ticks: { stroke: colour("--rule"), width: 1, size: 4 },
        grid: { stroke: colour("--rule"), width: 1 },
        values: (_, ticks) => ticks.map(short),
        splits: (chart, number, least, greatest) => {
            const isAcross = number === 0;
            const room = (isAcross ? chart.bbox.width : chart.bbox.height) / uPlot.pxRatio;
            return ticks(least, greatest, room / (line * (isAcross ? ACROSS : UP)));
        },
        ...more,
    });
    const drawn: uPlot.Series = { stroke: colour("--curve"), width: 2, pxAlign: 0, points: { show: false } };
    const options: uPlot.Options = {
        ...size,
        padding: [line * 0.7, line * 1.8, 0, 0],
        legend: { show: false },
        cursor: { show: false },
        scales: { x: { time: false }, y: { range: (_, least, greatest) => around(least, greatest) } },
        axes: [axis({ size: line * 2.1, gap: 3 }), axis({ side: 3, size: line * 4.6, gap: 4 })],
        series: [{}, isTime ? drawn : { ...drawn, paths: () => null }],
    };
    if (!isTime) {
        // over another column a curve goes to and fro
        options.scales!.x!.range = () => ends(shown()[0]);
        options.hooks = { draw: [(chart) => drawCurve(chart, ...shown(), colour("--curve"))] };
    }
    return new uPlot(options, dataOf(x, y), into);
}

function drawCurve(chart: uPlot, x: Series, y: Series, colour: string): void {
    const { ctx, bbox } = chart;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.beginPath();
    let before = false;
    x.values.forEach((value, row) => {
        const [left, top] = [chart.valToPos(value, "x", true), chart.valToPos(y.values[row]!, "y", true)];
        const there = Number.isFinite(left + top);
        if (there) before ? ctx.lineTo(left, top) : ctx.moveTo(left, top);
        before = there;
    });
    ctx.strokeStyle = colour;
    ctx.lineWidth = 2 * devicePixelRatio;
    ctx.stroke();
    ctx.restore();
}
