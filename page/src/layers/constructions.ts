// What a lecture draws into a mechanism: instant centres and polodes, a transmission angle, a cam's pitch curve and pressure angle.

import type { Document } from "../data/document.ts";
import { svg } from "../elements.ts";
import type { Anchor, Contact } from "../data/format.ts";
import { angleAt, centreOf, pitchCurve, pressure, touchOf, transmission } from "../motion/angles.ts";
import { anchors } from "../motion/meetings.ts";
import { OF_A_FRAME, placeOf, type Moment, type Motion, type Pair } from "../motion/motion.ts";
import { pole, polodes } from "../motion/poles.ts";
import { short } from "../numbers.ts";
import type { Camera } from "../picture/camera.ts";
import type { Pairing, Wishes } from "../wishes.ts";
import { inFrame, inUnits, throughWithin, type Box, type Layer } from "./layer.ts";

/** The radius of an angle's arc (pixels). */
const ARC = 34;

export class Poles implements Layer {
    readonly element = svg("g", { class: "poles", "aria-hidden": "true" });
    private readonly fixed = svg("path", { class: "polode polode-one" });
    private readonly moving = svg("path", { class: "polode polode-other" });
    private readonly curves = svg("g", {}, this.fixed, this.moving);
    private readonly cross = svg("path", { class: "pole" });
    private readonly text = svg("text", { class: "label" });
    private pairing: Pairing | undefined;
    private name = "";
    written: Box | undefined;

    show({ motion, scene }: Document, { pairing: asked }: Wishes, camera: Camera): void {
        // a variant that is not sound has no bodies
        const pairing = asked && Math.max(asked.one, asked.other) < scene.frames.length ? asked : undefined;
        this.pairing = pairing;
        this.written = undefined;
        this.element.replaceChildren();
        if (!pairing) return;
        const { one, other } = polodes(motion, pairing.one, pairing.other);
        this.fixed.setAttribute("d", pairing.polodes ? throughWithin(one, camera) : "");
        this.moving.setAttribute("d", pairing.polodes ? throughWithin(other, camera) : "");
        this.name = `P${subscript(pairing.one)}${subscript(pairing.other)}`;
        this.element.append(this.curves, this.cross, this.text);
    }

    draw(moment: Moment, camera: Camera): void {
        if (!this.pairing) return;
        const { one, other } = this.pairing;
        this.curves.setAttribute("transform", inUnits(camera));
        this.fixed.setAttribute("transform", inFrame(moment, one, camera));
        this.moving.setAttribute("transform", inFrame(moment, other, camera));
        const at = pole(moment, one, other);
        const [x, y] = at ? camera.pixel(at) : [NaN, NaN];
        const seen = Math.abs(x) < 1e5 && Math.abs(y) < 1e5;
        this.cross.setAttribute("d", seen ? `M${x - 8} ${y}h16M${x} ${y - 8}v16M${x - 5} ${y}a5 5 0 1 0 10 0a5 5 0 1 0 -10 0` : "");
        this.text.textContent = seen ? this.name : "";
        this.written = seen ? place(this.text, [x + 9, y - 9], camera) : undefined;
    }
}

function subscript(number: number): string {
    return [...String(number)].map((digit) => "₀₁₂₃₄₅₆₇₈₉"[Number(digit)]).join("");
}

export class Corners implements Layer {
    readonly element = svg("g", { class: "corners", "aria-hidden": "true" });
    private readonly legs = svg("path", { class: "legs" });
    private readonly arc = svg("path", { class: "arc" });
    private readonly text = svg("text", { class: "label" });
    private places: readonly Anchor[] | undefined;
    written: Box | undefined;

    show({ scene }: Document, { corner }: Wishes): void {
        this.written = undefined;
        this.places = corner && anchors(scene, [corner.one, corner.pin, corner.other]);
        this.element.replaceChildren(...(this.places ? [this.legs, this.arc, this.text] : []));
    }

    draw(moment: Moment, camera: Camera): void {
        if (!this.places) return;
        const [one, pin, other] = this.places as [Anchor, Anchor, Anchor];
        const at = camera.pixel(placeOf(moment, pin));
        let first = direction(at, camera.pixel(placeOf(moment, one)));
        const second = direction(at, camera.pixel(placeOf(moment, other)));
        this.legs.setAttribute("d", [one, other].map((to) => `M${at.join(" ")}L${camera.pixel(placeOf(moment, to)).join(" ")}`).join(""));
        // of the two angles between the lines the one that counts is drawn
        if (angleAt(moment, one, pin, other) > Math.PI / 2) first = [-first[0], -first[1]];
        this.written = drawArc(camera, this.arc, this.text, at, first, second, `μ = ${degrees(transmission(moment, one, pin, other))}`);
    }
}

export class Cams implements Layer {
    readonly element = svg("g", { class: "cams", "aria-hidden": "true" });
    private readonly pitch = svg("path", { class: "pitch-curve" });
    private readonly turned = svg("g", {}, this.pitch);
    private readonly normal = svg("path", { class: "legs" });
    private readonly arc = svg("path", { class: "arc" });
    private readonly text = svg("text", { class: "label" });
    private contact: Contact | undefined;
    private motion: Motion | undefined;
    written: Box | undefined;

    show({ motion, scene }: Document, { contact }: Wishes, camera: Camera): void {
        [this.contact, this.motion] = [contact === undefined ? undefined : scene.contacts[contact], motion];
        this.written = undefined;
        this.element.replaceChildren();
        if (!this.contact) return;
        this.pitch.setAttribute("d", throughWithin(pitchCurve(motion, this.contact), camera));
        this.element.append(this.turned, this.normal, this.arc, this.text);
    }

    draw(moment: Moment, camera: Camera): void {
        if (!this.contact || !this.motion) return;
        this.turned.setAttribute("transform", inUnits(camera));
        this.pitch.setAttribute("transform", inFrame(moment, this.contact.cam, camera));
        const touch = touchOf(this.motion, moment, this.contact);
        const angle = pressure(this.motion, moment, this.contact);
        if (!touch || angle === undefined) {
            for (const path of [this.normal, this.arc]) path.setAttribute("d", "");
            this.text.textContent = "";
            this.written = undefined;
            return;
        }
        // what slides has the angle at the middle of its roller as well, where it is seen better
        const centre = centreOf(this.contact);
        const isTurning = moment.frames[OF_A_FRAME * this.contact.follower + 5] !== 0;
        const at = camera.pixel(centre && !isTurning ? placeOf(moment, centre) : touch.at);
        // pixels run down
        const down = ([x, y]: Pair): Pair => [x / Math.hypot(x, y), -y / Math.hypot(x, y)];
        const goes = down(touch.velocity);
        let normal = down(touch.normal);
        // on the side to which the follower goes
        if (normal[0] * goes[0] + normal[1] * goes[1] < 0) normal = [-normal[0], -normal[1]];
        const reach = 2.2 * ARC * camera.grain;
        const line = ([dx, dy]: Pair) => `M${at[0] - reach * dx} ${at[1] - reach * dy}L${at[0] + reach * dx} ${at[1] + reach * dy}`;
        this.normal.setAttribute("d", line(normal) + line(goes));
        this.written = drawArc(camera, this.arc, this.text, at, normal, goes, `α = ${degrees(angle)}`);
    }
}

export function degrees(angle: number): string {
    return `${short(Number(((angle * 180) / Math.PI).toFixed(2)))}°`;
}

function direction([x, y]: Pair, [tx, ty]: Pair): Pair {
    const length = Math.hypot(tx - x, ty - y) || 1;
    return [(tx - x) / length, (ty - y) / length];
}

function drawArc(camera: Camera, arc: SVGPathElement, text: SVGTextElement, at: Pair, from: Pair, to: Pair, says: string): Box {
    const radius = ARC * camera.grain;
    const sweep = from[0] * to[1] - from[1] * to[0] > 0 ? 1 : 0;
    const end = ([dx, dy]: Pair) => `${at[0] + radius * dx} ${at[1] + radius * dy}`;
    arc.setAttribute("d", `M${end(from)}A${radius} ${radius} 0 0 ${sweep} ${end(to)}`);
    const middle = direction([0, 0], [from[0] + to[0], from[1] + to[1]]);
    text.textContent = says;
    return place(text, [at[0] + 1.4 * radius * middle[0], at[1] + 1.4 * radius * middle[1] + 5 * camera.grain], camera);
}

/** So large is a letter in parts of the usual size of letters, roughly. */
const LETTER: Pair = [9, 16];

/** Puts a text to a place, where it has this box, roughly: to measure it takes longer than all else. */
function place(text: SVGTextElement, [x, y]: Pair, { grain }: Camera): Box {
    text.setAttribute("x", x.toFixed(1));
    text.setAttribute("y", y.toFixed(1));
    const [wide, high] = LETTER;
    return [[x, y - 0.85 * high * grain], [x + wide * grain * (text.textContent?.length ?? 0), y + 0.25 * high * grain]];
}
