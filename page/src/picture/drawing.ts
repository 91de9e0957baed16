// What a picture of the mechanism must do, whoever draws it: an SVG, or a canvas where there is too much for one.

import type { Scene } from "../data/format.ts";
import type { Moment, Pair } from "../motion/motion.ts";
import type { Camera } from "./camera.ts";

export interface Drawing {
    readonly element: Element;
    /** Draws another scene from now on, if that has the same nodes in other shapes; says whether it does. */
    renew(scene: Scene, camera: Camera): boolean;
    /** The picture has another size, or is looked at from elsewhere. */
    look(camera: Camera): void;
    draw(moment: Moment, camera: Camera): void;
    /** Which declarations stand out. */
    light(lit: ReadonlySet<number>, wrong: ReadonlySet<number>): void;
    /** The declaration that is drawn at a pixel of the picture. */
    hit(at: Pair, event: Event): number | undefined;
    /** Shades of other moments behind it; none of them if empty. */
    shades(moments: readonly Moment[], camera: Camera): void;
}
