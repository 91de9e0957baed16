// How a live page reaches the program that it shows: over the address that it comes from, or through the editor that it is a panel of.

import { nameOf, shared } from "./shared.ts";

/** What is new: there is another version of the texts, or the editor's cursor is elsewhere in the file (UTF-16). */
export interface News {
    version: number;
    at: number | null;
    /** In which file it is, where that is not the page's own. */
    file?: string | null;
}

/** Values for params: what stands in their places, and what is to stand there, in the unit of the param. */
export interface Writing {
    version: number;
    changes: { name: string; old: string; value: number }[];
    sure: boolean;
}

export type Written = { written: true } | { asks: string } | { refused: string };

/** Whether the program is there; it may be asleep, or gone. */
export type State = "there" | "asleep" | "gone" | "refused";

export interface Transport {
    /** Tells of all news, and of every change of state, for as long as the page is there. */
    listen(tell: (news: News) => void, turned: (state: State) => void): void;
    ask(asked: object, signal: AbortSignal): Promise<ArrayBuffer>;
    write(writing: Writing): Promise<Written>;
    /** Shows a place of the file in the editor, where there is one (UTF-16). */
    show?(at: number): void;
}

/** So long after a connection was lost another one is tried (ms). */
const AGAIN = 250;
/** The program is heard every two seconds; one that is not heard for so long is asleep (ms). */
const PULSE_LOST = 5000;

/** To the server that the page comes from. What only its own pages know is in the fragment of their address. */
export class Connection implements Transport {
    private readonly headers: Record<string, string>;

    constructor() {
        this.headers = { "X-Mechc-Token": location.hash.slice(1) };
    }

    listen(tell: (news: News) => void, turned: (state: State) => void): void {
        // another token belongs to another program at the same address, of which nothing is known yet
        addEventListener("hashchange", () => location.reload());
        const hearing = (tell: (news: News) => void, turned: (state: State) => void) => this.hearing(tell, turned);
        void nameOf(location.hash).then((name) => shared(name, hearing, tell, turned));
    }

    private async hearing(tell: (news: News) => void, turned: (state: State) => void): Promise<never> {
        for (;;) {
            const state = await this.heard(tell, turned).catch((): State => "gone");
            turned(state);
            await new Promise((resolve) => setTimeout(resolve, state === "refused" ? 8 * AGAIN : AGAIN));
        }
    }

    /** Hears the program until it is gone. */
    private async heard(tell: (news: News) => void, turned: (state: State) => void): Promise<State> {
        const response = await this.post("/events", {});
        if (!response.ok || !response.body) return response.status === 403 ? "refused" : "gone";
        const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
        let rest = "";
        let last = performance.now();
        const watch = setInterval(() => {
            if (performance.now() - last > PULSE_LOST) turned("asleep");
        }, PULSE_LOST / 5);
        try {
            turned("there");
            for (;;) {
                const { done, value } = await reader.read();
                if (done) return "gone";
                if (performance.now() - last > PULSE_LOST) turned("there");
                last = performance.now();
                const lines = (rest + value).split("\n");
                rest = lines.pop()!;
                for (const line of lines) if (line) tell(JSON.parse(line) as News);
            }
        } finally {
            clearInterval(watch);
        }
    }

    /** By an older door than `fetch`, which takes a millisecond or two less: a slider's picture waits for it. */
    ask(asked: object, signal: AbortSignal): Promise<ArrayBuffer> {
        return new Promise((done, failed) => {
            const request = new XMLHttpRequest();
            request.open("POST", "/motion");
            request.responseType = "arraybuffer";
            for (const [name, value] of Object.entries(this.headers)) request.setRequestHeader(name, value);
            request.onload = () => (request.status === 200 ? done(request.response as ArrayBuffer) : failed(new Error(`the program refuses (${request.status})`)));
            request.onerror = () => failed(new TypeError("nobody is there"));
            request.onabort = () => failed(new TypeError("given up"));
            signal.addEventListener("abort", () => request.abort());
            request.send(JSON.stringify(asked));
        });
    }

    async write(writing: Writing): Promise<Written> {
        const response = await this.post("/write", writing);
        if (!response.ok) return { refused: `the program refuses (${response.status})` };
        return (await response.json()) as Written;
    }

    show(at: number): void {
        void this.post("/show", { at }).catch(() => undefined);
    }

    private post(path: string, body: object): Promise<Response> {
        return fetch(path, { method: "POST", headers: this.headers, body: JSON.stringify(body), cache: "no-store" });
    }
}

interface Editor {
    postMessage(message: object): void;
}

declare global {
    /** What a panel of VS Code speaks to its extension with. */
    var acquireVsCodeApi: (() => Editor) | undefined;
}

type Heard =
    | ({ kind: "news" } & News)
    | { kind: "state"; state: State }
    | { kind: "answer"; id: number; data: unknown }
    | { kind: "failed"; id: number; why: string };

/** To the extension of the editor that the page is a panel of. */
export class Panel implements Transport {
    private readonly waiting = new Map<number, { done: (data: unknown) => void; failed: (why: Error) => void }>();
    private asked = 0;

    constructor(private readonly editor: Editor) {}

    listen(tell: (news: News) => void, turned: (state: State) => void): void {
        addEventListener("message", ({ data }: MessageEvent<Heard>) => {
            if (data.kind === "news") tell(data);
            else if (data.kind === "state") turned(data.state);
            else {
                const waiting = this.waiting.get(data.id);
                this.waiting.delete(data.id);
                if (data.kind === "answer") waiting?.done(data.data);
                else waiting?.failed(new TypeError(data.why));
            }
        });
        this.editor.postMessage({ kind: "ready" });
    }

    async ask(asked: object, signal: AbortSignal): Promise<ArrayBuffer> {
        const data = await this.request({ kind: "ask", asked }, signal);
        // some hosts of panels turn buffers into arrays of their own kind
        return data instanceof ArrayBuffer ? data : new Uint8Array(data as ArrayLike<number>).slice().buffer;
    }

    async write(writing: Writing): Promise<Written> {
        return (await this.request({ kind: "write", asked: writing })) as Written;
    }

    show(at: number): void {
        this.editor.postMessage({ kind: "show", at });
    }

    private request(message: object, signal?: AbortSignal): Promise<unknown> {
        const id = ++this.asked;
        return new Promise((done, failed) => {
            this.waiting.set(id, { done, failed });
            signal?.addEventListener("abort", () => failed(new TypeError("given up")));
            this.editor.postMessage({ ...message, id });
        });
    }
}
