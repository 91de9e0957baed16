// A page that follows a file: what its reader has set, what was asked for that, and what is shown of the answers.

import { App } from "../app.ts";
import { answerOf, documentOf, momentOf, type Answer, type Jog, type Knob, type Told } from "../data/live.ts";
import type { Document } from "../data/document.ts";
import type { Page } from "../data/format.ts";
import { embedding } from "../embedding.ts";
import { short } from "../numbers.ts";
import { Knobs, type Refusal } from "../panes/knobs.ts";
import { Said } from "../panes/said.ts";
import { Hand } from "./hand.ts";
import { head } from "./head.ts";
import { Settings } from "./settings.ts";
import type { News, State, Transport } from "./transport.ts";

/** A question whose answer takes longer is given up for the next one, if there is one (ms). */
const PATIENCE = 150;
/** Where a picture of now takes longer (ms), the next one is asked for after so many times that: the motion alone is sooner there. */
const GLIMPSE = 80;
const SELDOM = 10;
/** The whole motion is asked for when a hand has rested so long (ms): the next picture does not wait for it. */
const REST = 50;
/** One that takes no more than so many times a picture of now is asked for at once, and plots follow the hand too. */
const AS_SOON = 1.3;
/** After a question that nobody answered (ms). */
const PAUSE = 250;
/** Who waits longer for an answer is told that it is being made (ms). */
const LONG = 500;

export class Live {
    private readonly id = crypto.randomUUID();
    private readonly said = new Said();
    private readonly knobs: Knobs;
    private readonly hand: Hand;
    private app: App | undefined;
    /** The version of the texts that there is; the one that is shown is that of what is told. */
    private newest = 0;
    private told: Told | undefined;
    private document: Document | undefined;
    private readonly settings = new Settings();
    /** Inputs that are moved by hand (SI), where they are in the picture, and the time that stands still for it. */
    private readonly moved = new Map<string, number>();
    private stood: readonly [name: string, value: number][] = [];
    private still: number | undefined;
    /** With what the motion was asked for that is shown. */
    private key = "";
    private hasChanged = false;
    /** From when on pictures of now are asked for. */
    private glimpsesFrom = 0;
    /** How long a picture of now took at least, 0 before there was one, and the last motion, from the question until they were drawn (ms). */
    private readonly took = { glimpse: 0, motion: Infinity };
    private interrupt: () => void = () => {};
    private working: Promise<void> | undefined;

    constructor(
        private readonly transport: Transport,
        private readonly place: HTMLElement,
    ) {
        this.knobs = new Knobs({
            set: (name, value) => void this.turn(name, value),
            value: (name) => this.inputNow(name),
            asInFile: () => this.asInFile(),
            timeAgain: () => this.timeAgain(),
            write: (sure) => this.write(sure),
            say: (text) => this.said.note(text),
        });
        this.hand = new Hand({
            crank: (input, value) => void this.turn(input, value),
            point: (name, at) => void this.movePoint(name, at),
            value: (input) => this.inputNow(input),
            seek: (time) => void this.app?.seek(time),
        });
        place.append(this.said.element);
        transport.listen(
            (news) => this.hear(news),
            (state) => this.turned(state),
        );
    }

    private hear({ version, at, file }: News): void {
        this.app?.point(at, file ?? null);
        if (version === this.newest) return;
        this.newest = version;
        void this.change();
    }

    private turned(state: State): void {
        this.said.state(state);
        // what was asked while nobody was there is asked again
        if (state === "there" && this.newest > 0) void this.change();
    }

    private get set(): Map<string, number> {
        return this.settings.values;
    }

    /** A param or an input has another value; settles when that is drawn. */
    async turn(name: string, value: number): Promise<void> {
        const isParam = this.told?.knobs?.some((knob) => knob.name === name) ?? false;
        if (isParam) {
            this.settings.set(name, value);
        } else if (this.told?.jogs?.some((jog) => jog.name === name)) {
            this.app?.pause();
            this.still ??= this.app?.time ?? 0;
            this.moved.set(name, value);
        } else {
            throw new Error(`there is no param and no input that is called ${name}`);
        }
        // what is asked is on its way before the page is busy
        const changed = this.change();
        this.knobs.at(this.set, this.moved);
        await changed;
        await this.app?.drawn();
    }

    private async movePoint(name: string, [x, y]: [number, number]): Promise<void> {
        for (const [axis, value] of [["x", x], ["y", y]] as const) {
            const knob = this.told?.knobs?.find((knob) => knob.name === `${name}.${axis}`);
            if (knob) this.settings.set(knob.name, value);
        }
        const changed = this.change();
        this.knobs.at(this.set, this.moved);
        await changed;
    }

    /** What an input is now (SI). */
    private inputNow(name: string): number {
        return this.moved.get(name) ?? this.app?.input(name) ?? NaN;
    }

    private asInFile(): void {
        this.settings.clear();
        this.said.kept("");
        this.knobs.at(this.set, this.moved);
        void this.change();
    }

    /** Inputs are again what their formulas say. */
    private timeAgain(): void {
        this.said.jog(null);
        if (this.still === undefined) return;
        this.letGo();
        this.knobs.at(this.set, this.moved);
        this.app?.stand(undefined);
    }

    private letGo(): void {
        [this.still, this.stood] = [undefined, []];
        this.moved.clear();
    }

    /** What cannot be written stays set, and does not keep the others from being written. */
    private async write(sure: boolean): Promise<Refusal | undefined> {
        const all = [...this.set].map(([name, value]) => ({ name, value, knob: this.settings.knob(name) }));
        const changes = all.flatMap(({ name, value, knob }) => (typeof knob?.text === "string" ? [{ name, old: knob.text, value }] : []));
        const others = all.filter(({ knob }) => typeof knob?.text !== "string");
        const elsewhere = others.map(({ name, knob }) => (knob?.where ? `${name} stands in ${knob.where}` : `this file does not say what ${name} is`)).join("; ");
        if (changes.length === 0) return elsewhere ? { says: `Nothing was written: ${elsewhere}.` } : undefined;
        const written = await this.transport.write({ version: this.told?.version ?? 0, changes, sure });
        if ("asks" in written) return { says: written.asks, isQuestion: true };
        if ("refused" in written) return { says: written.refused };
        const held = changes.flatMap(({ name }) => this.settings.knob(name)?.held ?? []);
        for (const { name, value } of changes) if (this.set.get(name) === value) this.set.delete(name);
        this.knobs.at(this.set, this.moved);
        void this.change();
        const says = [
            ...(held.length > 0 ? [`It stands in the file. The page goes on with what the command says: --set ${held.join(" --set ")}.`] : []),
            ...(elsewhere ? [`Not written: ${elsewhere}.`] : []),
        ];
        this.said.note(says.join(" "));
        return undefined;
    }

    /** Asks until what is shown is what is wanted. */
    private change(): Promise<void> {
        this.hasChanged = true;
        this.interrupt();
        this.working ??= this.work().finally(() => (this.working = undefined));
        return this.working;
    }

    /** First the picture of now, which comes sooner; then the motion, once the hand rests. A motion that is as soon comes alone. */
    private async work(): Promise<void> {
        while (this.hasChanged) {
            this.hasChanged = false;
            const isGlimpsed = !this.isMotionAsSoon && (await this.glimpse());
            if (isGlimpsed) await this.rest();
            if (isGlimpsed && this.hasChanged) continue;
            this.hasChanged = false;
            await this.once(isGlimpsed ? 0 : PATIENCE);
        }
    }

    private get isMotionAsSoon(): boolean {
        return this.took.motion <= AS_SOON * this.took.glimpse;
    }

    /** Settles when the hand has rested, or moves on. */
    private rest(): Promise<void> {
        return new Promise((resolve) => {
            if (this.hasChanged) resolve();
            this.interrupt = resolve;
            setTimeout(resolve, REST);
        });
    }

    /** What is set, as options have it. */
    private asked(): { set: [name: string, value: string][]; key: string } {
        const set = this.settings.asked();
        return { set, key: JSON.stringify(set) };
    }

    /** Shows where everything is now with what is set; says whether it does. */
    private async glimpse(): Promise<boolean> {
        const { app, document, told } = this;
        const { set, key } = this.asked();
        const isOther = this.still === undefined && told?.version === this.newest && key !== this.key;
        if (!app || !document || !isOther || performance.now() < this.glimpsesFrom || document.table.rows < 2) return false;
        const began = performance.now();
        const answer = await this.ask({ set, at: app.time, jog: null }, PATIENCE).catch(() => undefined);
        const took = performance.now() - began;
        if (took > GLIMPSE) this.glimpsesFrom = began + SELDOM * took;
        const there = answer?.live.glimpse && answer.live.version === told?.version ? momentOf(answer, document) : undefined;
        if (!there) return false;
        app.glimpse(there);
        // the least, for what else a machine does passes
        this.took.glimpse = Math.min(this.took.glimpse || Infinity, performance.now() - began);
        return true;
    }

    /** Asks for the motion, or where inputs are in it. */
    private async once(patience: number): Promise<void> {
        const [{ set, key }, values] = [this.asked(), new Map(this.set)];
        // the motion first, then where inputs are in it
        const isOfMotion = this.still === undefined || this.told?.version !== this.newest || key !== this.key;
        const jog = isOfMotion ? null : { time: this.still, inputs: [...this.moved] };
        try {
            const [began, isFirst] = [performance.now(), this.document === undefined];
            const answer = await this.ask({ set, jog }, patience);
            if (answer) this.take(answer, key, values);
            // the first one comes with the page, which takes its own time
            if (answer?.page && !isFirst) this.took.motion = performance.now() - began;
        } catch (error) {
            // nobody is there, which is said elsewhere, or what came cannot be shown
            if (!(error instanceof TypeError)) console.error(error);
            this.app?.goBack();
            await new Promise((resolve) => setTimeout(resolve, PAUSE));
        }
    }

    /** The answer to a question; none if there is another question by now, and this one took longer than some time (ms). */
    private async ask(asked: object, patience: number): Promise<Answer | undefined> {
        const abort = new AbortController();
        const began = performance.now();
        this.interrupt = () => {
            if (this.hasChanged && performance.now() - began >= patience) abort.abort();
        };
        const watch = setInterval(() => this.interrupt(), 20);
        const told = setTimeout(() => this.said.working(true), LONG);
        try {
            return answerOf(await this.transport.ask({ page: this.id, ...asked }, abort.signal));
        } catch (error) {
            if (abort.signal.aborted) return undefined;
            throw error;
        } finally {
            clearInterval(watch);
            clearTimeout(told);
            this.said.working(false);
            this.interrupt = () => {};
        }
    }

    private take(answer: Answer, key: string, asked: ReadonlyMap<string, number>): void {
        const { live, page } = answer;
        if (live.superseded) {
            this.hasChanged = true;
            return;
        }
        // an answer of a version that is not told yet comes before its news
        this.newest = Math.max(this.newest, live.version);
        if (live.wrong !== undefined) {
            this.takeWrong(live, live.wrong);
            return;
        }
        if (live.jog) {
            // where inputs are in another text: that text is to be seen first
            if (live.version === this.told?.version) this.takeJog(answer);
            else this.hasChanged = true;
            return;
        }
        this.said.right();
        if (page) this.takeMotion(answer, page, key, asked);
    }

    /** The text is wrong, or what is set cannot be in it. */
    private takeWrong({ knobs }: Told, wrong: string): void {
        this.app?.goBack();
        if (!knobs) {
            this.said.wrong(wrong, "the text", this.app !== undefined);
            return;
        }
        // what is set may have been set in another text
        if (this.follow(knobs, this.told?.jogs ?? [])) {
            this.hasChanged = true;
            return;
        }
        this.said.wrong(wrong, "what is set", this.app !== undefined);
        if (!this.told) return;
        this.told = { ...this.told, knobs };
        this.knobs.offer(knobs, this.told.jogs ?? [], this.set);
        this.knobs.at(this.set, this.moved);
    }

    /** There is another text: says whether something is set otherwise by that. */
    private follow(knobs: readonly Knob[], jogs: readonly Jog[]): boolean {
        const isOther = this.settings.follow(knobs);
        this.said.kept(this.settings.said);
        for (const name of [...this.moved.keys()]) if (!jogs.some((jog) => jog.name === name)) this.moved.delete(name);
        if (this.moved.size === 0) this.letGo();
        return isOther;
    }

    private takeMotion(answer: Answer, page: Page, key: string, asked: ReadonlyMap<string, number>): void {
        const { live } = answer;
        if (live.version !== this.told?.version) this.glimpsesFrom = 0;
        [this.told, this.key] = [live, key];
        if (this.follow(live.knobs ?? [], live.jogs ?? [])) this.hasChanged = true;
        const document = documentOf(answer, page);
        this.document = document;
        const app = (this.app ??= this.begin(document));
        head(page);
        // those of a motion that is not there have no values
        const values = (k: number) => answer.columns[page.columns.length + k] ?? new Float64Array(0);
        const inputs = (live.jogs ?? []).map(({ name }, k): [string, Float64Array] => [name, values(k)]);
        app.takeInputs(inputs);
        this.hand.offer(live, document, asked, this.set);
        // inputs that are moved by hand are where they are in this motion until it is known how far they get in it
        this.stood = [];
        app.show(document);
        this.knobs.offer(live.knobs ?? [], live.jogs ?? [], this.set, { inputs: new Map(inputs), extent: document.scene.extent });
        this.knobs.at(this.set, this.moved);
        if (this.still === undefined) this.said.jog(null);
        else this.hasChanged = true;
    }

    private takeJog(answer: Answer): void {
        const { reached, said } = answer.live.jog!;
        const { document } = this;
        if (this.still === undefined || !document) return;
        // what is said of the whole motion is not said once more
        const isSaid = said !== null && document.messages.some(({ code, severity }) => severity === "error" && said.includes(`[${code}]`));
        const there = momentOf(answer, document);
        this.said.jog(there || !isSaid ? said : "", `t = ${short(this.still)} s`);
        if (there) {
            this.app?.stand(there);
            this.stood = reached;
            this.hand.stood(there.motion.atRow(0, there.motion.moment()), new Map(reached), !this.hasChanged);
        }
        // who has gone on meanwhile is not called back
        if (this.hasChanged) return;
        this.moved.clear();
        for (const [name, value] of this.stood) this.moved.set(name, value);
        if (this.moved.size === 0) this.letGo();
        this.knobs.at(this.set, this.moved);
    }

    private begin(document: Document): App {
        const { page } = document;
        const app = new App(page, { page, document: () => Promise.resolve(this.document!) }, { knobs: this.knobs, said: this.said.element, hand: this.hand, timeMoves: () => this.timeAgain(), show: (at) => this.transport.show?.(at) });
        this.place.append(app.element);
        window.mechc = embedding(app, (name, value) => this.turn(name, value));
        app.show(document);
        app.begin();
        return app;
    }
}
