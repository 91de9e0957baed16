// What the page is given: the form of the JSON in it, number 1. `src/view/page` writes it. Lengths are metres, angles radians, times
// seconds; what a column is printed in stands beside it.

/** The number of the form that this script reads. */
export const FORMAT = 1;

/** Name, kind (`body`, `joint`, …), which text, and from where to where in it (UTF-16). */
export type Declaration = [name: string, kind: string, text: number, from: number, to: number];

export interface NamedPoint {
    name: string;
    declaration: number;
    frame: number;
    at: [number, number];
    /** Whether a joint takes hold there. */
    pin?: boolean;
}

/** A frame and a place in it. */
export type Anchor = [frame: number, x: number, y: number];

export interface Shape {
    /** What it means; a class of the style sheet. */
    look: string;
    /** An SVG path in metres, in absolute commands; as in every SVG its y axis points down. */
    d: string;
}

/** Something drawn: it moves with a frame, or stays upright at a place of one, or is held between two places. */
export interface Node {
    declaration: number;
    shapes: Shape[];
    fixed?: number;
    upright?: Anchor;
    /** x runs from one place to the other; its origin is at the one or the other, or it is stretched, 1 being the whole way. */
    between?: [from: Anchor, to: Anchor, held: "from" | "to" | "stretched"];
}

export interface Trace {
    declaration: number;
    /** In which frame it is written. */
    frame: number;
    /** A point of the frame. */
    at?: [number, number];
    /** Else the columns NAME.x and NAME.y hold it, */
    columns?: string;
    /** in a frame that is fixed so in the other one, */
    pose?: [x: number, y: number, phi: number];
    /** and turned over. */
    mirrored?: boolean;
}

export interface Profile {
    declaration: number;
    frame: number;
}

/** A cam and what it moves. */
export interface Contact {
    /** The joint. */
    declaration: number;
    cam: number;
    follower: number;
    /** What of the follower touches, in its frame: a point, */
    tip?: [number, number];
    /** or a circle, at centre + cos(w) arms[0] + sin(w) arms[1], where a column has w, */
    roller?: { centre: [number, number]; arms: [[number, number], [number, number]]; argument: string };
    /** or a straight face: a place of it, and its direction. */
    face?: [at: [number, number], along: [number, number]];
}

/** A force that takes hold of a place, in the directions of the ground (N). */
export interface ForceVector {
    declaration: number;
    kind: "reaction" | "load" | "weight";
    at: Anchor;
    /** Always the same; */
    constant?: [number, number];
    /** or two columns; */
    columns?: [string, string];
    /** or a column times a direction of a frame; */
    along?: [column: string, frame: number, direction: [number, number]];
    /** or a column times the direction from one place to another. */
    apart?: [column: string, from: Anchor, to: Anchor];
}

/** A torque about a place (N·m), counter-clockwise: a column times a sign. */
export interface Torque {
    declaration: number;
    kind: "reaction" | "load";
    at: Anchor;
    column: string;
    sign: 1 | -1;
}

export interface Scene {
    unit: number;
    extent: [[number, number], [number, number]];
    declarations: Declaration[];
    /** The declaration of each frame; frame 0 is the ground. */
    frames: number[];
    points: NamedPoint[];
    nodes: Node[];
    traces: Trace[];
    profiles: Profile[];
    contacts: Contact[];
    /** Left out where there are none. */
    forces?: ForceVector[];
    torques?: Torque[];
}

export interface Column {
    name: string;
    unit: string;
    /** What SI is divided by, multiplied with and divided by to be in the unit; left out where it is the unit. */
    scale?: [number, number, number];
    /** What a column of the table holds. */
    kind?: ColumnKind;
}

/**
 * Time; a coordinate of a body or one that a joint brings along, or a derivative of these; what joints exert, drivers supply and loads are;
 * what the text measures or traces, or a derivative of that; a derivative with something else than time.
 */
export type ColumnKind = "time" | "body" | "joint" | "reaction" | "measure" | "rate" | "variation";

/** A number for the whole motion, in SI, printed as a column is; null where it has no value. */
export interface Result extends Column {
    value: number | null;
}

export interface Label {
    text: number;
    from: number;
    to: number;
    says: string;
}

export interface Message {
    severity: string;
    code: string;
    text: string;
    labels?: Label[];
    notes?: string[];
    help?: string[];
    /** When it happened, where it happened on the way. */
    time?: number;
}

/** What makes one value of another: another one in an array of one, or what changes in an object or array, by key or place. */
export type Changes = [unknown] | { [key: string]: Changes };

export interface Variant {
    rows: number;
    data: string;
    results: Result[];
    messages: Message[];
    edges: number[];
    /** The declarations that errors name. */
    named?: number[];
    /** Where the frames are (x, y, phi of each) if there is no row: as they are drawn in the text. */
    drawn?: [number, number, number][];
    /** What its scene has that the page's has not. */
    scene?: Changes;
}

export interface Vary {
    name: string;
    unit: string;
    /** In the unit. */
    values: number[];
    /** Which of them the page begins with: the one nearest to the file's own. */
    nearest: number;
    /** The file's own, where it is none of them. */
    own: number | null;
}

export interface Page {
    format: number;
    mechc: string;
    name: string;
    docs: string;
    texts: { name: string; text: string }[];
    scene: Scene;
    columns: Column[];
    vary: Vary[];
    /** How large the whole page is. */
    bytes?: number;
    /** In the order of the product of what varies, the last fastest. */
    variants: Variant[];
    /** Why rows were left out, if they were. */
    thinned?: string;
}
