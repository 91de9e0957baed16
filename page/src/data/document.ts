// One motion, unpacked: what all panes show. A page from a file has its variants in it; one that is fed from elsewhere makes new
// documents as it goes. Nothing here draws.

import { FORMAT, type Message, type Page, type Result, type Scene, type Variant } from "./format.ts";
import { changed } from "./changes.ts";
import { bytesOfBase64, columnsOf, inflated } from "./inflate.ts";
import { Table } from "./table.ts";
import { Motion } from "../motion/motion.ts";

export interface Document {
    readonly page: Page;
    readonly variant: number;
    readonly scene: Scene;
    readonly table: Table;
    readonly motion: Motion;
    readonly results: readonly Result[];
    readonly messages: readonly Message[];
    /** The declarations that errors name. */
    readonly named: readonly number[];
}

function listed<T>(one: readonly T[], other: readonly T[], same: (one: T, other: T) => boolean): boolean {
    return one.length === other.length && one.every((entry, k) => same(entry, other[k]!));
}

/** Whether two documents declare the same: names, places in the text, bodies and points. */
export function declareAlike(one: Document | undefined, other: Document): boolean {
    if (one === undefined) return false;
    const [a, b] = [one.scene, other.scene];
    return (
        a === b ||
        (listed(a.declarations, b.declarations, (one, other) => listed<unknown>(one, other, Object.is)) &&
            listed(a.frames, b.frames, Object.is) &&
            listed(a.points, b.points, (one, other) => one.name === other.name && one.frame === other.frame && one.pin === other.pin) &&
            listed(a.contacts, b.contacts, (one, other) => one.declaration === other.declaration && one.cam === other.cam && one.follower === other.follower))
    );
}

/** Where documents come from. */
export interface Source {
    readonly page: Page;
    /** The document of a variant. */
    document(variant: number): Promise<Document>;
    /** Makes ready, in the browser's idle time, what may be asked for. */
    prepare?(): void;
}

async function unpacked(page: Page, variant: number): Promise<Document> {
    const from: Variant | undefined = page.variants[variant];
    if (!from) throw new Error(`there is no variant ${variant}`);
    const scene = from.scene ? changed(page.scene, from.scene) : page.scene;
    const columns = page.columns.length;
    const bytes = from.rows > 0 ? await inflated(bytesOfBase64(from.data)) : new Uint8Array(columns);
    const table = new Table(page.columns, columnsOf(bytes, from.rows, columns));
    const motion = new Motion(scene, table, from.edges, from.drawn);
    const { results, messages, named = [] } = from;
    return { page, variant, scene, table, motion, results, messages, named };
}

/** So many tables are kept unpacked at the most. */
const KEPT_BYTES = 200e6;

/** What stands in the page itself. */
export class Embedded implements Source {
    private readonly kept = new Map<number, Promise<Document>>();

    constructor(readonly page: Page) {}

    static of(text: string): Embedded {
        const page = JSON.parse(text) as Page;
        if (page.format !== FORMAT) throw new Error(`this page is of form ${page.format}, its script reads ${FORMAT}`);
        return new Embedded(page);
    }

    prepare(): void {
        const { variants, columns } = this.page;
        const size = variants.reduce((sum, { rows }) => sum + 8 * rows * columns.length, 0);
        if (variants.length < 2 || size > KEPT_BYTES) return;
        const one = async (variant: number): Promise<void> => {
            await this.document(variant);
            if (variant + 1 < variants.length) setTimeout(() => void one(variant + 1), 0);
        };
        setTimeout(() => void one(0), 0);
    }

    document(variant: number): Promise<Document> {
        let made = this.kept.get(variant);
        if (!made) {
            const size = 8 * this.page.columns.length * (this.page.variants[variant]?.rows ?? 0);
            if (this.kept.size * size > KEPT_BYTES) this.kept.clear();
            made = unpacked(this.page, variant);
            this.kept.set(variant, made);
        }
        return made;
    }
}
