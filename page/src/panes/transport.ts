// Time: play, scrub, speed, and what happens at an end.

import type { Document } from "../data/document.ts";
import { button, html, press, sign } from "../elements.ts";
import { told, type Clock } from "../motion/clock.ts";
import type { Moment } from "../motion/motion.ts";
import { six } from "../numbers.ts";
import type { Wishes } from "../wishes.ts";
import type { Deeds, Pane } from "./pane.ts";

const PLAY = "M8 5l11 7-11 7z";
const PAUSE = "M7 5h4v14H7zM14 5h4v14h-4z";

export class Transport implements Pane {
    readonly element = html("div", { class: "transport", role: "group", "aria-label": "time" });
    private readonly playing = button("play", sign(PLAY), { class: "play" });
    private readonly scrubber = html("input", { type: "range", min: 0, max: 1, step: "any", value: 0, "aria-label": "time" });
    private readonly marks = html("div", { class: "marks", "aria-hidden": "true" });
    private readonly time = html("output", { class: "time", "aria-live": "off" });
    private readonly row = html("span", { class: "row" });
    private readonly factor = html("output", { class: "factor", "aria-label": "speed" });
    private readonly turning = button("to and fro", sign("M4 9h16l-4-4M20 15H4l4 4"), { "aria-pressed": "false" });
    private readonly spoken = html("div", { class: "spoken", role: "status", "aria-live": "polite" });
    private document: Document | undefined;
    private isShownPlaying: boolean | undefined;

    constructor(
        private readonly clock: Clock,
        deeds: Deeds,
    ) {
        const back = button("a row back", sign("M17 5l-9 7 9 7zM6 5v14"));
        const on = button("a row on", sign("M7 5l9 7-9 7zM18 5v14"));
        const slower = button("slower", sign("M5 12h14"));
        const faster = button("faster", sign("M12 5v14M5 12h14"));
        this.element.append(
            html("div", { class: "scrub" }, this.scrubber, this.marks),
            html(
                "div",
                { class: "controls" },
                html("div", { class: "group" }, back, this.playing, on),
                html("div", { class: "now" }, this.time, this.row),
                html("div", { class: "group speed" }, slower, this.factor, faster, this.turning),
            ),
            this.spoken,
        );
        back.addEventListener("click", () => deeds.step(-1));
        on.addEventListener("click", () => deeds.step(1));
        slower.addEventListener("click", () => this.change(() => clock.slower()));
        faster.addEventListener("click", () => this.change(() => clock.faster()));
        this.playing.addEventListener("click", () => (clock.playing ? deeds.pause() : deeds.play()));
        this.turning.addEventListener("click", () => this.turnOver());
        this.scrubber.addEventListener("input", () => {
            deeds.pause();
            void deeds.seek(Number(this.scrubber.value));
        });
    }

    /** The slider, which takes the keys of time itself. */
    get slider(): HTMLInputElement {
        return this.scrubber;
    }

    turnOver(): void {
        this.clock.turning = this.clock.turning === "loop" ? "to and fro" : "loop";
        press(this.turning, this.clock.turning === "to and fro");
    }

    change(what: () => void): void {
        what();
        this.factor.textContent = told(this.clock.rate);
    }

    /** Says the time, once it stands. */
    say(): void {
        const text = `${this.time.textContent}, ${this.row.textContent}`;
        if (this.spoken.textContent !== text) this.spoken.textContent = text;
    }

    show(document: Document, _: Wishes): void {
        if (this.document === document) return;
        this.document = document;
        const { motion, table, messages } = document;
        const { from } = motion;
        const moves = table.rows > 1;
        // a motion that stops does so behind its last row
        const stops = messages.flatMap(({ severity, time }) => (severity === "error" && time !== undefined ? [time] : []));
        const to = moves ? Math.max(motion.to, ...stops) : motion.to;
        Object.assign(this.scrubber, { min: String(from), max: String(to > from ? to : from + 1) });
        this.scrubber.disabled = !moves;
        for (const made of this.element.querySelectorAll("button")) made.disabled = !moves;
        const mark = (time: number, kind: string, title: string) => {
            const made = html("span", { class: `mark ${kind}`, title });
            made.style.left = `${(100 * (time - from)) / (to - from)}%`;
            return made;
        };
        const isEdge = (time: number) => motion.edges.some((edge) => Math.abs(edge - time) <= 1e-6 * (to - from));
        const within = (time: number) => to > from && time >= from && time <= to + 1e-6 * (to - from);
        this.marks.replaceChildren(
            ...motion.edges.filter(within).map((time) => mark(time, "edge", "accelerations jump here")),
            ...messages.flatMap(({ severity, time, text }) => {
                if (!moves || time === undefined || !within(time)) return [];
                if (severity === "error") return [mark(time, "stop", text)];
                return isEdge(time) ? [] : [mark(time, "remark", text)];
            }),
        );
        this.factor.textContent = told(this.clock.rate);
    }

    draw(moment: Moment): void {
        const { table } = this.document!;
        this.time.textContent = moment.row < 0 ? "no motion" : `t = ${six(moment.time)} s`;
        this.row.textContent = moment.row < 0 ? "" : `row ${moment.row + 1} of ${table.rows}`;
        this.scrubber.value = String(moment.time);
        this.scrubber.setAttribute("aria-valuetext", `${this.time.textContent}, ${this.row.textContent}`);
        if (this.isShownPlaying === this.clock.playing) return;
        this.isShownPlaying = this.clock.playing;
        const says = this.clock.playing ? "pause" : "play";
        this.playing.replaceChildren(sign(this.clock.playing ? PAUSE : PLAY));
        this.playing.setAttribute("aria-label", says);
        this.playing.title = `${says} (Space)`;
    }
}
