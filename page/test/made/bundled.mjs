// The page's modules as a test imports them: TypeScript, made into a module of its own.

import { build } from "esbuild";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");

export async function bundled(path) {
    const { outputFiles } = await build({ entryPoints: [join(root, "src", path)], bundle: true, format: "esm", write: false, target: "es2022" });
    return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].text).toString("base64")}`);
}
