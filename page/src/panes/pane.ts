// A part of the page. What it shows comes from outside, and so does when it draws: it neither knows where data come from nor keeps time.

import type { Document } from "../data/document.ts";
import type { Moment } from "../motion/motion.ts";
import type { Wishes } from "../wishes.ts";

export interface Pane {
    readonly element: HTMLElement;
    /** There is another motion, or other wishes. */
    show(document: Document, wishes: Wishes): void;
    /** It is another time. */
    draw(moment: Moment): void;
    /** The pointer is elsewhere, or something else was chosen. */
    light?(wishes: Wishes): void;
}

/** What panes may ask of the page. */
export interface Deeds {
    seek(time: number): Promise<void>;
    /** By so many rows. */
    step(rows: number): void;
    play(): void;
    pause(): void;
}
