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
    ["N", "forces, where the text has masses or loads"],
    ["T", "traces"],
    ["S", "strobe"],
    ["F", "the picture alone, larger, for a lecture hall"],
    ["0", "show all of it"],
    ["?", "this help"],
];

/** What is elsewhere on the page, by the words of a lecture. */
const PLACES: readonly [string, string][] = [
    ["instant centre, polodes", "“Closer look”, of two bodies"],
    ["transmission angle μ", "“Closer look”, at a pin where two bodies meet; it can be plotted"],
    ["pressure angle α, pitch curve", "“Closer look”, at a joint of a cam; it can be plotted"],
    ["any column over any other", "in a plot’s head, and with “+” above the plots"],
    ["numbers row by row", "“Table”"],
];

export function help(mechc: string): HTMLDialogElement {
    const close = html("button", { type: "submit", autofocus: true }, "close");
    return html(
        "dialog",
        { class: "help", "aria-label": "help" },
        html("h2", {}, "Keys"),
        html("dl", {}, ...KEYS.flatMap(([key, does]) => [html("dt", {}, html("kbd", {}, key)), html("dd", {}, does)])),
        html("h2", {}, "Where things are"),
        html("dl", { class: "places" }, ...PLACES.flatMap(([what, where]) => [html("dt", {}, what), html("dd", {}, where)])),
        html("p", {}, "A click on a point shows its velocity and acceleration; the pointer on anything tells what it is and where it is declared."),
        html("p", { class: "made-by" }, `Made by mechc ${mechc}. Plots by uPlot (MIT licence, © Leon Sorokin).`),
        html("form", { method: "dialog" }, close),
    );
}
