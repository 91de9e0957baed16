// What a lecture draws into a mechanism: instant centres and polodes, a transmission angle, a cam's pitch curve and pressure angle.

import type { Document } from "../data/document.ts";
import { svg } from "../elements.ts";
import { alongPitch, angleAt, pitchCurve, pressure, transmission, type Contact } from "../motion/angles.ts";
import { placeOf, velocityOf, type Moment, type Pair } from "../motion/motion.ts";
import { pole, polodes } from "../motion/poles.ts";
import { short } from "../numbers.ts";
import type { Camera } from "../picture/camera.ts";
import type { Corner, Pairing, Wishes } from "../wishes.ts";
import { inFrame, inUnits, throughWithin, type Layer } from "./layer.ts";

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

    show({ motion }: Document, { pairing }: Wishes, camera: Camera): void {
        this.pairing = pairing;
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
        if (seen) place(this.text, [x + 9, y - 9]);
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
    private corner: Corner | undefined;

    show(_: Document, { corner }: Wishes): void {
        this.corner = corner;
        this.element.replaceChildren(...(corner ? [this.legs, this.arc, this.text] : []));
    }

    draw(moment: Moment, camera: Camera): void {
        if (!this.corner) return;
        const { one, pin, other } = this.corner;
        const at = camera.pixel(placeOf(moment, pin));
        let first = direction(at, camera.pixel(placeOf(moment, one)));
        const second = direction(at, camera.pixel(placeOf(moment, other)));
        this.legs.setAttribute("d", [one, other].map((to) => `M${at.join(" ")}L${camera.pixel(placeOf(moment, to)).join(" ")}`).join(""));
        // of the two angles between the lines the one that counts is drawn
        if (angleAt(moment, one, pin, other) > Math.PI / 2) first = [-first[0], -first[1]];
        drawArc(this.arc, this.text, at, first, second, `μ = ${degrees(transmission(moment, one, pin, other))}`);
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

    show({ motion }: Document, { contact }: Wishes, camera: Camera): void {
        this.contact = contact;
        this.element.replaceChildren();
        if (!contact) return;
        this.pitch.setAttribute("d", throughWithin(pitchCurve(motion, contact), camera));
        this.element.append(this.turned, this.normal, this.arc, this.text);
    }

    draw(moment: Moment, camera: Camera): void {
        if (!this.contact) return;
        this.turned.setAttribute("transform", inUnits(camera));
        this.pitch.setAttribute("transform", inFrame(moment, this.contact.cam, camera));
        const at = camera.pixel(placeOf(moment, this.contact.centre));
        const angle = pressure(moment, this.contact);
        const [tx, ty] = alongPitch(moment, this.contact);
        const [vx, vy] = velocityOf(moment, this.contact.centre);
        const length = Math.hypot(tx, ty);
        // the normal, on the side to which the follower goes; pixels run down
        let normal: Pair = [-ty / length, -tx / length];
        const way = Math.hypot(vx, vy);
        const goes: Pair = [vx / way, -vy / way];
        if (normal[0] * goes[0] + normal[1] * goes[1] < 0) normal = [-normal[0], -normal[1]];
        const seen = angle !== undefined && Number.isFinite(normal[0]);
        const reach = 2.2 * ARC;
        const line = ([dx, dy]: Pair) => `M${at[0] - reach * dx} ${at[1] - reach * dy}L${at[0] + reach * dx} ${at[1] + reach * dy}`;
        this.normal.setAttribute("d", seen ? line(normal) + line(goes) : "");
        if (seen) drawArc(this.arc, this.text, at, normal, goes, `α = ${degrees(angle)}`);
        else {
            this.arc.setAttribute("d", "");
            this.text.textContent = "";
        }
    }
}

export function degrees(angle: number): string {
    return `${short(Number(((angle * 180) / Math.PI).toFixed(2)))}°`;
}

function direction([x, y]: Pair, [tx, ty]: Pair): Pair {
    const length = Math.hypot(tx - x, ty - y) || 1;
    return [(tx - x) / length, (ty - y) / length];
}

function drawArc(arc: SVGPathElement, text: SVGTextElement, at: Pair, from: Pair, to: Pair, says: string): void {
    const sweep = from[0] * to[1] - from[1] * to[0] > 0 ? 1 : 0;
    const end = ([dx, dy]: Pair) => `${at[0] + ARC * dx} ${at[1] + ARC * dy}`;
    arc.setAttribute("d", `M${end(from)}A${ARC} ${ARC} 0 0 ${sweep} ${end(to)}`);
    const middle = direction([0, 0], [from[0] + to[0], from[1] + to[1]]);
    text.textContent = says;
    place(text, [at[0] + 1.4 * ARC * middle[0], at[1] + 1.4 * ARC * middle[1] + 5]);
}

function place(text: SVGTextElement, [x, y]: Pair): void {
    text.setAttribute("x", x.toFixed(1));
    text.setAttribute("y", y.toFixed(1));
}
