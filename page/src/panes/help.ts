// The keys, and what else there is to know.

import { html } from "../elements.ts";

const KEYS: readonly [string, string][] = [
    ["Space", "play, pause"],
    ["← →", "a row back, on"],
    ["Shift ← →", "ten rows"],
    ["Home End", "begin, end"],
    ["+ −", "faster, slower"],
    ["B", "to and fro, or round and round"],
    ["L", "labels"],
    ["V", "velocities and accelerations at all pins"],
    ["T", "traces"],
    ["S", "strobe"],
    ["F", "the picture alone, for a lecture hall"],
    ["0", "show all of it"],
    ["?", "this help"],
];

export function help(mechc: string): HTMLDialogElement {
    const close = html("button", { type: "submit", autofocus: true }, "close");
    return html(
        "dialog",
        { class: "help", "aria-label": "help" },
        html("h2", {}, "Keys"),
        html("dl", {}, ...KEYS.flatMap(([key, does]) => [html("dt", {}, html("kbd", {}, key)), html("dd", {}, does)])),
        html("p", {}, "A click on a point shows its velocity and acceleration; the pointer on anything tells what it is and where it is declared."),
        html("p", { class: "made-by" }, `Made by mechc ${mechc}. Plots by uPlot (MIT licence, © Leon Sorokin).`),
        html("form", { method: "dialog" }, close),
    );
}
