// What a page offers to tests, and to whoever embeds it.

import type { App } from "./app.ts";
import { printed } from "./data/table.ts";

export interface Mechc {
    /** Shows a time (s); resolves when it is drawn. */
    seek(time: number): Promise<void>;
    play(): void;
    pause(): void;
    readonly time: number;
    /** The names of a row's numbers. */
    readonly columns: readonly string[];
    /** The numbers now, in the units of the table; those of the table at the times of its rows. */
    row(): number[];
    /** Where every pin is in the page (CSS pixels). */
    pins(): { point: string; x: number; y: number }[];
    /**
     * Sets what was varied to the nearest of its values (in its unit); on a page that follows a file, a param (in its unit) or an input
     * (SI); resolves when it is drawn.
     */
    set(name: string, value: number): Promise<void>;
    /** The medians of the time between two drawings and of the time that one took, of the last second of play (ms). */
    readonly pace: { between: number; drawing: number };
}

declare global {
    interface Window {
        mechc: Mechc;
    }
}

/** What an app offers; `set` is another one where params are not varied beforehand. */
export function embedding(app: App, set = (name: string, value: number) => app.set(name, value)): Mechc {
    return {
        seek: (time) => app.seek(time),
        play: () => app.play(),
        pause: () => app.pause(),
        get time() {
            return app.time;
        },
        get columns() {
            return (app.shown?.page ?? app.page).columns.map(({ name }) => name);
        },
        row: () => {
            const shown = app.shown;
            return shown ? shown.page.columns.map((column, place) => printed(column, shown.motion.value(place, app.time))) : [];
        },
        pins: () => app.picture.pins(),
        set,
        get pace() {
            return app.pace;
        },
    };
}
