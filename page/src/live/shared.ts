// One stream of news for all tabs of a browser. A browser has few connections to a server at once, and a stream holds one for good: so
// the tab that has a lock hears the program, and tells the others. When it goes, the next one has the lock.

import type { News, State } from "./transport.ts";

/** What a tab tells the others: what it heard last, or that it is new and wants to know. */
type Word = { asks: true } | { asks?: undefined; news: News | undefined; state: State | undefined };

/** Hears the program for as long as the page is there. */
type Hearing = (tell: (news: News) => void, turned: (state: State) => void) => Promise<never>;

/** Tells of all that the program says, whichever tab hears it; tabs of one name belong together. */
export function shared(name: string, hearing: Hearing, tell: (news: News) => void, turned: (state: State) => void): void {
    if (!navigator.locks || !globalThis.BroadcastChannel) {
        void hearing(tell, turned);
        return;
    }
    const channel = new BroadcastChannel(name);
    let hears = false;
    let news: News | undefined;
    let state: State | undefined;
    const take = (heard: { news: News | undefined; state: State | undefined }) => {
        // the tab that hears says the same again when it has lost the program and found it, and to those that are new
        const [isNews, isTurn] = [heard.news !== undefined && JSON.stringify(heard.news) !== JSON.stringify(news), heard.state !== undefined && heard.state !== state];
        [news, state] = [heard.news ?? news, heard.state ?? state];
        if (isTurn) turned(state!);
        if (isNews) tell(news!);
    };
    channel.addEventListener("message", ({ data }: MessageEvent<Word>) => {
        if (!data.asks) take(data);
        else if (hears) channel.postMessage({ news, state } satisfies Word);
    });
    channel.postMessage({ asks: true } satisfies Word);
    const pass = (heard: { news: News | undefined; state: State | undefined }) => {
        take(heard);
        channel.postMessage(heard satisfies Word);
    };
    void navigator.locks.request(name, () => {
        hears = true;
        return hearing(
            (heard) => pass({ news: heard, state: undefined }),
            (heard) => pass({ news: undefined, state: heard }),
        );
    });
}

/** A name that says nothing of a secret that it is made of: other programs may have had pages at the same address. */
export async function nameOf(secret: string): Promise<string> {
    const digest = await crypto.subtle.digest("SHA-256", new TextEncoder().encode(`mechc ${secret}`));
    return Array.from(new Uint8Array(digest), (byte) => byte.toString(16).padStart(2, "0")).join("");
}
