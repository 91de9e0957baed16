// The mechanism as SVG: a group for each node, moved by its transform.

import type { Scene } from "../data/format.ts";
import { svg } from "../elements.ts";
import type { Moment, Pair } from "../motion/motion.ts";
import type { Camera } from "./camera.ts";
import type { Drawing } from "./drawing.ts";
import { areAlike, figures, placed, renewed, stretched, type Figure } from "./figures.ts";

interface Drawn {
    figure: Figure;
    group: SVGGElement;
    paths: SVGPathElement[];
}

export class SvgDrawing implements Drawing {
    readonly element = svg("g", { class: "mechanism" });
    private readonly behind = svg("g", { class: "shades", "aria-hidden": "true" });
    private readonly drawn: Drawn[];

    constructor(scene: Scene, camera: Camera) {
        this.drawn = figures(scene, camera).map((figure) => drawnFigure(scene, figure));
        this.element.append(this.behind, ...this.drawn.map(({ group }) => group));
    }

    renew({ nodes }: Scene, camera: Camera): boolean {
        const { drawn } = this;
        if (nodes.length !== drawn.length || !nodes.every((node, k) => areAlike(drawn[k]!.figure.node, node))) return false;
        nodes.forEach((node, k) => {
            const { figure, paths } = drawn[k]!;
            for (const shape of renewed(figure, node, camera)) paths[shape]!.setAttribute("d", figure.shapes[shape]!.d);
        });
        return true;
    }

    look(camera: Camera): void {
        const [x, y] = camera.origin;
        this.element.setAttribute("transform", `translate(${x} ${y}) scale(${camera.pixels} ${-camera.pixels})`);
    }

    draw(moment: Moment, camera: Camera): void {
        for (const { figure, group, paths } of this.drawn) move(figure, group, paths, moment, camera);
    }

    light(lit: ReadonlySet<number>, wrong: ReadonlySet<number>): void {
        for (const { figure, group } of this.drawn) {
            group.classList.toggle("lit", lit.has(figure.node.declaration));
            group.classList.toggle("wrong", wrong.has(figure.node.declaration));
        }
    }

    hit(_: Pair, event: Event): number | undefined {
        const group = event.target instanceof Element ? event.target.closest("g[data-declaration]") : null;
        return group ? Number(group.getAttribute("data-declaration")) : undefined;
    }

    shades(moments: readonly Moment[], camera: Camera): void {
        this.behind.replaceChildren(
            ...moments.map((moment) => {
                const shade = svg("g", { class: "shade" });
                for (const { figure, group } of this.drawn.filter(({ figure }) => figure.frame > 0 || figure.stretches)) {
                    const copy = group.cloneNode(true) as SVGGElement;
                    for (const name of ["data-body", "data-joint", "data-declaration"]) copy.removeAttribute(name);
                    copy.classList.remove("lit", "wrong");
                    move(figure, copy, [...copy.querySelectorAll("path")], moment, camera);
                    shade.append(copy);
                }
                return shade;
            }),
        );
    }
}

function drawnFigure(scene: Scene, figure: Figure): Drawn {
    const [name, kind] = scene.declarations[figure.node.declaration] ?? ["", ""];
    const group = svg("g", {
        class: `node ${figure.tint}`,
        "data-declaration": figure.node.declaration,
        "data-body": kind === "body" || kind === "ground" ? name : undefined,
        "data-joint": kind === "joint" ? name : undefined,
    });
    const paths = figure.shapes.map(({ look, d }) => svg("path", { class: `look-${look}`, d }));
    group.append(...paths);
    return { figure, group, paths };
}

function move(figure: Figure, group: SVGGElement, paths: SVGPathElement[], moment: Moment, camera: Camera): void {
    const [cos, sin, x, y] = placed(figure, moment, camera);
    const [c, s] = [cos.toFixed(7), sin.toFixed(7)];
    group.setAttribute("transform", `matrix(${c} ${s} ${-Number(s)} ${c} ${x.toFixed(3)} ${y.toFixed(3)})`);
    if (figure.stretches) paths.forEach((path, k) => path.setAttribute("d", stretched(figure, k, moment)));
}
