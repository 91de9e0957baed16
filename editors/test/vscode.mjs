// What a user does in VS Code with the page of a text: opens it by its lens, clicks in it, turns a slider, writes, makes a mistake.
// node editors/test/vscode.mjs, in code-server with the packaged extension (editors/vscode/mech.vsix). CODE_SERVER is the folder of its npm
// package, NODE a Node that runs it (4.139 wants 24), MECHC mechc, CHROMIUM a browser, PLAYWRIGHT the package playwright-core, which that of
// the page has. SHOT names a picture to take of the editor.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const { CODE_SERVER, NODE = "node", CHROMIUM = "/usr/bin/chromium", SHOT } = process.env;
const { MECHC = here("../../target/debug/mechc"), PLAYWRIGHT = here("../../page/node_modules/playwright-core") } = process.env;
const { chromium } = await import(pathToFileURL(join(PLAYWRIGHT, "index.mjs")));
/** A machine that does something else as well is given time (ms). */
const PATIENCE = 60_000;

const work = mkdtempSync(join(tmpdir(), "vscode-"));
const [data, extensions, folder] = ["data", "extensions", "mechanisms"].map((name) => join(work, name));
const file = join(folder, "slider_crank.mech");
mkdirSync(folder);
copyFileSync(here("../../examples/slider_crank.mech"), file);
mkdirSync(join(data, "User"), { recursive: true });
const settings = {
    "mechc.path": MECHC,
    "security.workspace.trust.enabled": false,
    "workbench.startupEditor": "none",
    "workbench.colorTheme": "Default Light Modern",
    "workbench.secondarySideBar.defaultVisibility": "hidden",
    "editor.minimap.enabled": false,
    "chat.disableAIFeatures": true,
};
writeFileSync(join(data, "User", "settings.json"), JSON.stringify(settings));
const server = [join(CODE_SERVER, "out/node/entry.js"), "--config", join(work, "config.yaml"), "--user-data-dir", data, "--extensions-dir", extensions];
execFileSync(NODE, [...server, "--install-extension", here("../vscode/mech.vsix")], { stdio: "ignore" });

/** A port that nobody listens at. */
const port = await new Promise((resolve) => {
    const asked = createServer().listen(0, "127.0.0.1", () => {
        const { port } = asked.address();
        asked.close(() => resolve(port));
    });
});
// a password, for who else is on this machine
const password = crypto.randomUUID();
const options = ["--auth", "password", "--bind-addr", `127.0.0.1:${port}`, "--disable-telemetry", "--disable-update-check"];
const running = spawn(NODE, [...server, ...options, folder], { stdio: "ignore", env: { ...process.env, PASSWORD: password } });
const browser = await chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox", "--disable-gpu"] });
const context = await browser.newContext({ viewport: { width: 1500, height: 900 } });
context.setDefaultTimeout(PATIENCE);
const editor = await context.newPage();

const steps = {};

steps.lens = async () => {
    for (const began = Date.now(); ; ) {
        const answer = await editor.goto(`http://127.0.0.1:${port}/?folder=${encodeURIComponent(folder)}`).catch(() => undefined);
        if (answer?.ok()) break;
        assert.ok(Date.now() - began < PATIENCE, "code-server does not start");
        await editor.waitForTimeout(300);
    }
    await editor.fill("input[type=password]", password);
    await editor.press("input[type=password]", "Enter");
    await editor.getByRole("treeitem", { name: "slider_crank.mech" }).dblclick();
    // the list of files makes room
    await editor.keyboard.press("Control+B");
    await editor.locator(".codelens-decoration a", { hasText: "view" }).click();
};

/** The page in its panel: a frame in a frame. */
const panel = () => editor.frameLocator("iframe.webview").frameLocator("iframe");

steps.panel = async () => {
    await panel().locator('[data-body="rod"]').first().waitFor();
    assert.equal(await panel().locator("h1").textContent(), "slider_crank");
    // one sentence alone, so that there is room for the picture
    assert.match(await panel().locator(".docs > p").textContent(), /in a cylinder\.$/);
    await panel().locator("button.play").click();
    await panel().locator(".picture").click({ position: { x: 5, y: 5 } });
    await panel().locator("body").press("Home");
};

/** The line of some words, counted from one. */
const lineOf = (words) => readFileSync(file, "utf8").split("\n").findIndex((line) => line.includes(words)) + 1;

steps.clicked = async () => {
    for (const body of ["rod", "piston"]) {
        await panel().locator(`[data-body="${body}"] *`).first().dispatchEvent("click", { bubbles: true });
        await editor.locator(".active-line-number", { hasText: new RegExp(`^${lineOf(`body ${body} at`)}$`) }).waitFor();
    }
};

steps.lit = async () => {
    await editor.locator(".view-line", { hasText: "body crank" }).click({ position: { x: 60, y: 8 } });
    await panel().locator('[data-body="crank"].lit, [data-body="crank"] .lit, .lit [data-body="crank"]').first().waitFor({ state: "attached" });
    await shot();
};

/** The text in the editor. */
const text = () => editor.locator(".view-lines").first().innerText().then((text) => text.replace(/\u00a0/g, " "));
const has = async (words) => {
    for (const began = Date.now(); !(await text()).includes(words); await editor.waitForTimeout(50)) {
        assert.ok(Date.now() - began < PATIENCE, `the editor has no ${words}:\n${await text()}`);
    }
};

steps.written = async () => {
    const field = panel().getByLabel("rod_length, a number");
    await field.fill("165");
    await field.press("Enter");
    await panel().locator('.knob.changed [data-param="rod_length"]').waitFor();
    await panel().getByText("Write into the file").click();
    await has("rod_length   = 165 mm");
    // whose text it is, saves it
    assert.match(readFileSync(file, "utf8"), /rod_length   = 150 mm/);
};

steps.mistake = async () => {
    await editor.locator(".view-line", { hasText: "joint big:" }).click({ position: { x: 60, y: 8 } });
    await editor.keyboard.press("End");
    await editor.keyboard.type("x");
    await panel().locator(".broken:not([hidden]) pre").waitFor();
    await shot("-mistake");
    await editor.keyboard.press("Backspace");
    await panel().locator(".broken").waitFor({ state: "hidden" });
};

steps.saved = async () => {
    await editor.keyboard.press("Control+S");
    for (const began = Date.now(); !readFileSync(file, "utf8").includes("rod_length   = 165 mm"); await editor.waitForTimeout(50)) {
        assert.ok(Date.now() - began < PATIENCE, readFileSync(file, "utf8"));
    }
    // the page goes on with the text that is saved
    await panel().locator('[data-param="rod_length"][aria-valuetext="165"]').waitFor();
};

async function shot(more = "") {
    await editor.waitForTimeout(SHOT ? 1500 : 0);
    if (SHOT) await editor.screenshot({ path: SHOT.replace(/\.png$/, `${more}.png`) });
}

let fault;
for (const [name, step] of Object.entries(steps)) {
    const began = Date.now();
    fault = await step().then(() => undefined, (fault) => fault);
    console.log(`vscode: ${name} ${fault ? `FAULT ${fault.stack}` : `${Date.now() - began} ms`}`);
    if (fault) break;
}
if (fault && SHOT) await editor.screenshot({ path: SHOT.replace(/\.png$/, "-fault.png") });
await browser.close();
running.kill();
await new Promise((resolve) => running.on("exit", resolve));
rmSync(work, { recursive: true, force: true, maxRetries: 5 });
process.exit(fault ? 1 : 0);
