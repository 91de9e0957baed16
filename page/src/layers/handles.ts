// Points of the drawing that can be moved by hand: those that params of the file are.

import { svg } from "../elements.ts";
import type { Pair } from "../motion/motion.ts";
import type { Camera } from "../picture/camera.ts";

/** The half of a handle's side, and the radius of what a pointer has to meet (pixels). */
const HALF = 6;
const REACH = 13;

export class Handles {
    readonly element = svg("g", { class: "handles" });
    private names = "";

    draw(points: readonly { name: string; at: Pair }[], camera: Camera): void {
        const names = points.map(({ name }) => name).join();
        if (names !== this.names) {
            this.names = names;
            this.element.replaceChildren(
                ...points.map(({ name }) =>
                    svg(
                        "g",
                        { class: "handle", "data-handle": name },
                        svg("circle", { class: "reach", r: REACH }),
                        svg("path", { d: `M0 ${-HALF}L${HALF} 0L0 ${HALF}L${-HALF} 0Z` }),
                        svg("title", {}, `${name}: move it`),
                    ),
                ),
            );
        }
        points.forEach(({ at }, k) => {
            const [x, y] = camera.pixel(at);
            this.element.children[k]!.setAttribute("transform", `translate(${x.toFixed(2)} ${y.toFixed(2)})`);
        });
    }
}
