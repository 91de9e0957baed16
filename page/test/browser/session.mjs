// An editor's session with `mechc lsp`: it types, and asks what is wrong.

import { spawn } from "node:child_process";
import { MECHC } from "./served.mjs";

const URI = "file:///typed/row.mech";

/** A session in which a text is open. */
export async function session(text) {
    const process = spawn(MECHC, ["lsp"], { stdio: ["pipe", "pipe", "ignore"] });
    const waiting = new Map();
    let heard = Buffer.alloc(0);
    let id = 0;
    process.stdout.on("data", (bytes) => {
        heard = Buffer.concat([heard, bytes]);
        for (;;) {
            const end = heard.indexOf("\r\n\r\n");
            const length = Number(/Content-Length: (\d+)/i.exec(heard.subarray(0, Math.max(end, 0)).toString())?.[1] ?? NaN);
            if (end < 0 || heard.length < end + 4 + length) return;
            const message = JSON.parse(heard.subarray(end + 4, end + 4 + length).toString());
            heard = heard.subarray(end + 4 + length);
            if (message.method === undefined) waiting.get(message.id)?.(message.result);
            else if (message.id !== undefined) send({ id: message.id, result: null });
        }
    });
    const send = (message) => {
        const body = JSON.stringify({ jsonrpc: "2.0", ...message });
        process.stdin.write(`Content-Length: ${Buffer.byteLength(body)}\r\n\r\n${body}`);
    };
    const notify = (method, params) => send({ method, params });
    const request = (method, params) =>
        new Promise((resolve) => {
            waiting.set(++id, resolve);
            send({ id, method, params });
        });
    const textDocument = { uri: URI };
    let version = 1;
    await request("initialize", { processId: null, rootUri: null, capabilities: { textDocument: { diagnostic: {} } } });
    notify("initialized", {});
    notify("textDocument/didOpen", { textDocument: { uri: URI, languageId: "mech", version, text } });
    return {
        request: (method, params = {}) => request(method, { textDocument, ...params }),
        /** Puts something in the place of a stretch of a line; settles when it is known what is wrong, and says so. */
        async type(line, [from, to], typed) {
            const range = { start: { line, character: from }, end: { line, character: to } };
            version += 1;
            notify("textDocument/didChange", { textDocument: { uri: URI, version }, contentChanges: [{ range, text: typed }] });
            return (await request("textDocument/diagnostic", { textDocument })).items;
        },
        async end() {
            const ended = new Promise((resolve) => process.on("exit", resolve));
            await request("shutdown", null);
            notify("exit", null);
            return ended;
        },
    };
}
