// The page: brings together where data come from, time, and what is shown.

import { Embedded, type Document, type Source } from "./data/document.ts";
import { App } from "./app.ts";
import { embedding } from "./embedding.ts";
import { html } from "./elements.ts";
import { Live } from "./live/live.ts";
import { Connection, Panel } from "./live/transport.ts";

const began = async (): Promise<void> => {
    const data = document.getElementById("mechc")!.textContent!;
    if (data === "") {
        new Live(globalThis.acquireVsCodeApi ? new Panel(globalThis.acquireVsCodeApi()) : new Connection(), document.getElementById("page")!);
        return;
    }
    const source: Source = Embedded.of(data);
    const app = new App(source.page, source);
    document.getElementById("page")!.append(app.element);
    window.mechc = embedding(app);
    const first: Document = await source.document(app.firstVariant);
    app.show(first);
    app.begin();
};

began().catch((error: unknown) => {
    // what cannot be read is said where the picture would be
    document.getElementById("page")!.append(html("p", { role: "alert" }, `This page cannot be shown: ${String(error)}`));
});
