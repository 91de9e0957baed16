// The name and the first words of a mechanism, above all else; of a page that is written they stand in its file (`src/view/page.rs`).

import type { Page } from "../data/format.ts";
import { html } from "../elements.ts";

/** What is said there, which stays as a reader has unfolded it until something else is said. */
let told: string | undefined;

export function head({ name, docs }: Page): void {
    document.title = name;
    document.querySelector(".head h1 bdi")!.textContent = name;
    if (docs === told) return;
    told = docs;
    const [first, rest] = sentences(docs);
    const words = html("div", { class: "docs" }, html("p", {}, first));
    if (rest) words.append(" ", html("details", {}, html("summary", {}, "more"), html("p", { class: "rest" }, rest)));
    document.querySelector(".head .docs")?.remove();
    if (first) document.querySelector(".head")!.append(words);
}

/** The first sentence of a text, and the rest: it ends at a mark with a space behind, which is not that of an initial. */
export function sentences(docs: string): [first: string, rest: string] {
    const text = docs.trim();
    for (const { index } of text.matchAll(/[.!?](?=\s)/g)) {
        const word = /[\p{L}\p{N}]*$/u.exec(text.slice(0, index))![0];
        if (/^\p{Lu}$/u.test(word)) continue;
        return [text.slice(0, index + 1), text.slice(index + 1).trimStart()];
    }
    return [text, ""];
}
