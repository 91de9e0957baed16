// Builds dist/: the script and the style sheet, each one file; the page around them, whose policy allows these very two; and the notices
// of what is in them. The same sources and the same lock file give the same bytes.

import { build } from "esbuild";
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, "dist");
const from = (...path) => readFileSync(join(here, ...path), "utf8");

async function bundled(entry, more) {
    const made = await build({
        entryPoints: [join(here, entry)],
        absWorkingDir: here,
        bundle: true,
        minify: true,
        write: false,
        charset: "utf8",
        legalComments: "none",
        target: ["chrome111", "firefox113", "safari16.4"],
        ...more,
    });
    const text = made.outputFiles[0].text.trim();
    // neither may end the element that it stands in
    if (/<\/(script|style)|<!--/i.test(text)) throw new Error(`${entry}: it would end its element`);
    return text;
}

const script = await bundled("src/main.ts", { format: "iife" });
const own = await bundled("src/page.css", {});
const charts = await bundled("node_modules/uplot/dist/uPlot.min.css", {});
const style = `${charts}\n${own}`;
const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const policy = [
    "default-src 'none'",
    `script-src ${hash(script)}`,
    `style-src ${hash(style)}`,
    "base-uri 'none'",
    "form-action 'none'",
].join("; ");
const { version } = JSON.parse(from("node_modules/uplot/package.json"));
const notices = `uPlot ${version}, https://github.com/leeoniya/uPlot\n\n${from("node_modules/uplot/LICENSE").trim()}\n`;
// a page that asks a program is allowed to, by the gap behind
const page = from("src/page.html").replace("{{policy}}", `${policy}{{connect}}`);

writeFileSync(join(out, "page.js"), script);
writeFileSync(join(out, "page.css"), style);
writeFileSync(join(out, "page.html"), page);
writeFileSync(join(out, "notices.txt"), notices);
