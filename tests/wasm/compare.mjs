// Tables of the library as WebAssembly against those of the binary, byte for byte, and what is deepest, with the stack of a page:
// node compare.mjs MODULE FOLDER_OF_TABLES FILE.mech …
import { readFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";

const [path, tables, ...files] = process.argv.slice(2);
const module = new WebAssembly.Module(readFileSync(path));
// nothing is imported: no clock, no files, no environment
const start = () => new WebAssembly.Instance(module).exports;
const answer = (library, length) => Buffer.from(Array.from({ length }, (_, at) => library.get(at))).toString();

function give(library, text) {
  library.begin_text();
  for (const byte of Buffer.from(text)) library.put(byte);
}

let faults = 0;
function check(name, holds, text) {
  if (holds) return;
  faults += 1;
  console.error(`${name}: ${text}`);
}

for (const file of files) {
  const library = start();
  const text = readFileSync(file, "utf8");
  give(library, text);
  for (const [, name] of text.matchAll(/\b(?:spline|use)\s+"([^"]*)"/g)) {
    give(library, name);
    give(library, readFileSync(join(dirname(file), name), "utf8"));
  }
  const table = answer(library, library.run());
  const wanted = readFileSync(join(tables, basename(file, ".mech") + ".csv"), "utf8");
  check(file, table === wanted, `another table:\n${table.slice(0, 400)}`);
}

let ways = 0;
for (let library = start(); ; ways++) {
  try {
    const length = library.run_deep(ways);
    if (length === 0) break;
    const text = answer(library, length);
    const isTooLarge = text.startsWith("functions with branches: refused") && text.includes("E0410");
    check(`way ${ways}`, isTooLarge || /^.*: ok\n/.test(text), text.slice(0, 400));
  } catch (error) {
    check(`way ${ways}`, false, error);
    library = start();
  }
}
check("ways", ways > 20, `only ${ways}`);
check("files", files.length > 0, "none");
console.log(`WebAssembly: ${files.length} tables and ${ways} deep texts, ${faults} faults`);
process.exit(faults === 0 ? 0 : 1);
