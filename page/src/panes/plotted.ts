// A plot on paper: as SVG, of our own, for the charts on the screen are canvases.

import { svg } from "../elements.ts";
import { set, short } from "../numbers.ts";
import { around, ticks, type Series } from "./series.ts";

const [WIDTH, HEIGHT] = [480, 190];
const [LEFT, RIGHT, TOP, BOTTOM] = [64, 12, 20, 30];
/** About so many marks on the axes. */
const [ACROSS, UP] = [8, 5];

export function plotted(x: Series, y: Series): SVGSVGElement {
    const range = ({ values }: Series) => {
        const known = values.filter(Number.isFinite);
        return known.length > 0 ? [Math.min(...known), Math.max(...known)] as const : ([0, 1] as const);
    };
    const [from, to] = x.name === "t" ? range(x) : around(...range(x));
    const [least, greatest] = around(...range(y));
    const across = (value: number) => LEFT + ((value - from) / (to - from || 1)) * (WIDTH - LEFT - RIGHT);
    const up = (value: number) => HEIGHT - BOTTOM - ((value - least) / (greatest - least)) * (HEIGHT - TOP - BOTTOM);
    const name = ({ name, unit }: Series) => (set(unit) ? `${name} (${set(unit)})` : name);
    const made = svg("svg", { class: "plotted", viewBox: `0 0 ${WIDTH} ${HEIGHT}` });
    for (const value of ticks(from, to, ACROSS)) {
        const at = across(value).toFixed(1);
        made.append(svg("path", { class: "grid", d: `M${at} ${TOP}V${HEIGHT - BOTTOM}` }));
        made.append(svg("text", { x: at, y: HEIGHT - BOTTOM + 14, "text-anchor": "middle" }, short(value)));
    }
    for (const value of ticks(least, greatest, UP)) {
        const at = up(value).toFixed(1);
        made.append(svg("path", { class: "grid", d: `M${LEFT} ${at}H${WIDTH - RIGHT}` }));
        made.append(svg("text", { x: LEFT - 6, y: Number(at) + 4, "text-anchor": "end" }, short(value)));
    }
    let d = "";
    let before = false;
    x.values.forEach((value, row) => {
        const there = Number.isFinite(value + y.values[row]!);
        if (there) d += `${before ? "L" : "M"}${across(value).toFixed(2)} ${up(y.values[row]!).toFixed(2)}`;
        before = there;
    });
    made.append(
        svg("rect", { class: "frame", x: LEFT, y: TOP, width: WIDTH - LEFT - RIGHT, height: HEIGHT - TOP - BOTTOM }),
        svg("path", { class: "curve", d }),
        svg("text", { class: "title", x: LEFT, y: TOP - 7 }, name(y)),
        svg("text", { x: WIDTH - RIGHT, y: HEIGHT - 3, "text-anchor": "end" }, name(x)),
    );
    return made;
}
