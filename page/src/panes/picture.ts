// The picture: the mechanism, what lies over it, and the pointer.

import type { Document } from "../data/document.ts";
import { button, html, sign, svg } from "../elements.ts";
import { Labels, Points } from "../layers/points.ts";
import { Cams, Corners, Poles } from "../layers/constructions.ts";
import type { Layer } from "../layers/layer.ts";
import { Traces } from "../layers/traces.ts";
import { Forces } from "../layers/forces.ts";
import { Vectors } from "../layers/vectors.ts";
import { anchor } from "../motion/meetings.ts";
import { placeOf, type Moment, type Motion, type Pair } from "../motion/motion.ts";
import { Handles } from "../layers/handles.ts";
import type { Grasp, Hold } from "../live/hand.ts";
import { Camera } from "../picture/camera.ts";
import { CanvasDrawing } from "../picture/canvas.ts";
import type { Drawing } from "../picture/drawing.ts";
import { SvgDrawing } from "../picture/svg.ts";
import { toggle, type Wishes } from "../wishes.ts";
import { factsOf } from "./facts.ts";
import type { Pane } from "./pane.ts";

/** Beyond so many bodies a canvas draws. */
export const BODIES_IN_SVG = 300;
/** So near to a pin on a canvas is on it (pixels). */
const ON_A_PIN = 10;
/** Moments that a strobe shows. */
const STROBE = 9;
/** A step of the wheel. */
const WHEEL = 1.0015;
/** The size of letters at which everything has its usual size (pixels). */
const USUAL_LETTERS = 16;
/** A press that moved no farther is a click (pixels). */
const CLICK = 4;

export class Picture implements Pane {
    readonly element = html("div", { class: "picture", role: "group", "aria-label": "the mechanism" });
    /** The buttons in its corner. */
    readonly views = html("div", { class: "views", role: "group", "aria-label": "view" });
    private readonly over = svg("svg", { class: "over", role: "img", "aria-label": "the mechanism, drawn" });
    private readonly note = html("div", { class: "note", role: "presentation", hidden: true });
    private readonly pointsLayer = new Points();
    private readonly handles = new Handles();
    private readonly layers: Layer[];
    private readonly bare: Layer[];
    /** What takes hold of things, where the page can move them. */
    hand: Grasp | undefined;
    private camera: Camera | undefined;
    private drawing: Drawing | undefined;
    private document: Document | undefined;
    private wishes: Wishes | undefined;
    private moment: Moment | undefined;
    private isStrobe = false;
    private strobeOf: Motion | undefined;
    private wrong: ReadonlySet<number> = new Set();

    constructor() {
        const others = [new Traces(), new Poles(), new Corners(), new Cams(), new Vectors(), new Forces()];
        this.bare = [...others, new Labels(others)];
        this.layers = [...this.bare.slice(0, 1), this.pointsLayer, ...this.bare.slice(1)];
        this.views.append(
            this.viewButton("nearer", "M12 5v14M5 12h14", () => this.camera?.nearer(1.25)),
            this.viewButton("farther", "M5 12h14", () => this.camera?.nearer(0.8)),
            this.viewButton("show all of it", "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5", () => this.camera?.whole()),
        );
        this.element.append(this.over, this.views, this.note);
        this.listen();
        new ResizeObserver(() => this.resized()).observe(this.element);
    }

    /** Every pin with its place in the page (CSS pixels). */
    pins(): { point: string; x: number; y: number }[] {
        const { document, moment, camera } = this;
        if (!document || !moment || !camera) return [];
        const { left, top } = this.over.getBoundingClientRect();
        return document.scene.points.map((point) => {
            const [x, y] = camera.pixel(placeOf(moment, anchor(point)));
            return { point: point.name, x: left + x, y: top + y };
        });
    }

    /** All of it in sight again. */
    whole(): void {
        this.camera?.whole();
        this.looked();
    }

    show(document: Document, wishes: Wishes): void {
        this.wishes = wishes;
        if (this.document !== document) this.unfold(document);
        const camera = this.camera!;
        for (const layer of this.shownLayers()) layer.show(document, wishes, camera);
        this.showStrobe();
        this.light();
    }

    /** The mechanism as another document has it at a moment; what is drawn of its whole motion stays. */
    glimpse(document: Document, moment: Moment): void {
        this.unfold(document);
        if (this.shownLayers().includes(this.pointsLayer)) this.pointsLayer.show(document);
        this.draw(moment);
    }

    draw(moment: Moment): void {
        this.moment = moment;
        const { camera, drawing } = this;
        if (!camera || !drawing) return;
        this.element.classList.toggle("empty", moment.row < 0 && (this.document?.table.rows ?? 0) === 0 && this.document!.scene.nodes.length === 0);
        drawing.draw(moment, camera);
        for (const layer of this.shownLayers()) layer.draw(moment, camera);
        this.handles.draw(this.hand?.points() ?? [], camera);
    }

    private shownLayers(): Layer[] {
        return this.drawing instanceof CanvasDrawing ? this.bare : this.layers;
    }

    /** Another document: the same way of looking, if the scene is of the same size. */
    private unfold(document: Document): void {
        const before = this.camera;
        const sameScene = this.document?.scene === document.scene;
        // where other bodies are is not known yet
        if (this.document?.scene.frames.length !== document.scene.frames.length) this.moment = undefined;
        this.document = document;
        this.wrong = new Set(document.named);
        if (sameScene && this.drawing) return;
        if (before?.fits(document.scene) && this.drawing?.renew(document.scene, before)) return;
        this.camera = new Camera(document.scene);
        if (before) this.camera.as(before);
        const many = document.scene.frames.length > BODIES_IN_SVG;
        this.drawing?.element.remove();
        this.drawing = many ? new CanvasDrawing(document.scene, this.camera) : new SvgDrawing(document.scene, this.camera);
        if (many) this.element.prepend(this.drawing.element);
        const layers = this.shownLayers().map(({ element }) => element);
        this.over.replaceChildren(...(many ? [] : [this.drawing.element]), ...layers, this.handles.element);
        // to measure anew takes longer than all else
        if (before) this.looked();
        else this.resized();
    }

    /** Its size, or that of letters, is another. */
    resized(): void {
        const { width, height } = this.over.getBoundingClientRect();
        if (!this.camera || width === 0 || height === 0) return;
        [this.camera.width, this.camera.height] = [width, height];
        this.camera.grain = parseFloat(getComputedStyle(this.element).fontSize) / USUAL_LETTERS;
        this.looked();
    }

    private looked(): void {
        const { camera, drawing, moment } = this;
        if (!camera || !drawing) return;
        this.over.setAttribute("viewBox", `0 0 ${camera.width} ${camera.height}`);
        drawing.look(camera);
        if (moment) this.draw(moment);
    }

    private showStrobe(): void {
        const { document, wishes, camera, drawing } = this;
        if (!document || !wishes || !camera || !drawing) return;
        if (wishes.strobe === this.isStrobe && (this.strobeOf === document.motion || !wishes.strobe)) return;
        [this.isStrobe, this.strobeOf] = [wishes.strobe, document.motion];
        const { motion, table } = document;
        const count = wishes.strobe && table.rows > 1 ? STROBE : 0;
        const times = Array.from({ length: count }, (_, k) => motion.from + (k / STROBE) * (motion.to - motion.from));
        drawing.shades(times.map((time) => motion.at(time, motion.moment())), camera);
    }

    light(): void {
        const { document, wishes } = this;
        if (!document || !wishes) return;
        const lit = new Set(wishes.pointed);
        if (wishes.chosen !== undefined) lit.add(wishes.chosen);
        this.drawing?.light(lit, this.wrong);
        this.pointsLayer.light(lit);
        if (this.moment && this.drawing instanceof CanvasDrawing) this.drawing.draw(this.moment, this.camera!);
    }

    private viewButton(says: string, d: string, does: () => void): HTMLButtonElement {
        const made = button(says, sign(d));
        made.addEventListener("click", () => {
            does();
            this.looked();
        });
        return made;
    }

    private pixelOf(event: MouseEvent): Pair {
        const { left, top } = this.over.getBoundingClientRect();
        return [event.clientX - left, event.clientY - top];
    }

    private listen(): void {
        let from: Pair | undefined;
        let moved = 0;
        let hold: Hold | undefined;
        const over = this.over;
        over.addEventListener("pointerdown", (event) => {
            if (event.button !== 0) return;
            from = this.pixelOf(event);
            moved = 0;
            hold = this.grasped(from, event);
            if (!hold) return;
            over.setPointerCapture(event.pointerId);
            // what is told of a place is of where it was
            this.note.hidden = true;
        });
        over.addEventListener("pointermove", (event) => {
            const at = this.pixelOf(event);
            if (from && hold && event.buttons === 1) {
                moved += Math.hypot(at[0] - from[0], at[1] - from[1]);
                if (moved > CLICK) hold.move(this.camera!.place(at), this.camera!.metres);
                from = at;
            } else if (from && event.buttons === 1) {
                moved += Math.hypot(at[0] - from[0], at[1] - from[1]);
                if (moved > CLICK && event.pointerType === "mouse") {
                    this.camera?.move([at[0] - from[0], at[1] - from[1]]);
                    this.looked();
                }
                from = at;
            } else {
                this.point(at, event);
            }
        });
        // a page that scrolls under a finger would take from it what it holds
        over.addEventListener("touchmove", (event) => hold && event.preventDefault(), { passive: false });
        over.addEventListener("pointerleave", () => this.pointNowhere());
        const letGo = () => {
            hold?.end?.();
            hold = undefined;
        };
        over.addEventListener("pointerup", letGo);
        over.addEventListener("pointercancel", letGo);
        over.addEventListener("click", (event) => {
            from = undefined;
            if (moved <= CLICK) this.choose(this.pixelOf(event), event);
        });
        over.addEventListener(
            "wheel",
            (event) => {
                // a page that scrolls goes on scrolling
                if (!event.ctrlKey && document.documentElement.scrollHeight > innerHeight + 1) return;
                event.preventDefault();
                this.camera?.nearer(WHEEL ** -event.deltaY, this.pixelOf(event));
                this.looked();
            },
            { passive: false },
        );
    }

    /** What is under the pointer, in the hand. */
    private grasped(at: Pair, event: Event): Hold | undefined {
        const { hand, camera, moment } = this;
        if (!hand || !camera || !moment) return undefined;
        const handle = event.target instanceof Element ? event.target.closest("[data-handle]") : null;
        if (handle) return hand.point(handle.getAttribute("data-handle")!);
        const scene = this.document!.scene;
        // where a pin holds several bodies, the one that can be turned
        const near = scene.points.filter((point) => {
            const [x, y] = camera.pixel(placeOf(moment, anchor(point)));
            return Math.hypot(x - at[0], y - at[1]) < ON_A_PIN;
        });
        const hit = scene.frames.indexOf(this.declarationAt(at, event) ?? -1);
        for (const frame of [hit, ...near.map(({ frame }) => frame)]) {
            const hold = hand.body(frame, camera.place(at), moment);
            if (hold) return hold;
        }
        return undefined;
    }

    private pointAt(at: Pair, event: Event): number | undefined {
        const spot = event.target instanceof Element ? event.target.closest(".spot") : null;
        if (spot) return Number(spot.getAttribute("data-number"));
        if (!(this.drawing instanceof CanvasDrawing)) return undefined;
        const { left, top } = this.over.getBoundingClientRect();
        const pins = this.pins();
        const away = pins.map(({ x, y }) => Math.hypot(x - left - at[0], y - top - at[1]));
        const nearest = away.indexOf(Math.min(...away));
        return (away[nearest] ?? Infinity) < ON_A_PIN ? nearest : undefined;
    }

    private declarationAt(at: Pair, event: Event): number | undefined {
        const point = this.pointAt(at, event);
        return point === undefined ? this.drawing?.hit(at, event) : this.document?.scene.points[point]?.declaration;
    }

    private point(at: Pair, event: Event): void {
        const { wishes, document, moment } = this;
        if (!wishes || !document || !moment) return;
        const declaration = this.declarationAt(at, event);
        wishes.point(declaration === undefined ? [] : [declaration]);
        this.note.hidden = declaration === undefined;
        if (declaration === undefined) return;
        const { title, kind, facts } = factsOf(document, declaration, moment);
        this.note.replaceChildren(
            html("strong", {}, title),
            ` ${kind}`,
            html("dl", {}, ...facts.slice(0, 6).flatMap(({ name, text }) => [html("dt", {}, name), html("dd", {}, text)])),
        );
        const { offsetWidth, offsetHeight } = this.note;
        const beside = at[0] + 18 + offsetWidth > this.element.clientWidth ? at[0] - 12 - offsetWidth : at[0] + 18;
        this.note.style.left = `${Math.max(0, beside)}px`;
        this.note.style.top = `${Math.max(0, Math.min(at[1] + 14, this.element.clientHeight - offsetHeight - 4))}px`;
    }

    private pointNowhere(): void {
        this.note.hidden = true;
        this.wishes?.point([]);
    }

    private choose(at: Pair, event: Event): void {
        const point = this.pointAt(at, event);
        const declaration = this.declarationAt(at, event);
        this.wishes?.change((wishes) => {
            wishes.chosen = declaration;
            if (point === undefined) return;
            toggle(wishes.vectorsAt, point);
            if (!wishes.vectorsAt.has(point)) wishes.chosen = undefined;
        });
    }
}
