// Making elements. Text goes in as text, never as HTML.

type Attributes = Record<string, string | number | boolean | undefined>;
type Child = globalThis.Node | string | undefined;

const SVG = "http://www.w3.org/2000/svg";

function dressed<E extends Element>(element: E, attributes: Attributes, children: Child[]): E {
    for (const [name, value] of Object.entries(attributes)) {
        if (value === undefined || value === false) continue;
        element.setAttribute(name, value === true ? "" : String(value));
    }
    element.append(...children.filter((child) => child !== undefined));
    return element;
}

export function html<K extends keyof HTMLElementTagNameMap>(
    name: K,
    attributes: Attributes = {},
    ...children: Child[]
): HTMLElementTagNameMap[K] {
    return dressed(document.createElement(name), attributes, children);
}

export function svg<K extends keyof SVGElementTagNameMap>(
    name: K,
    attributes: Attributes = {},
    ...children: Child[]
): SVGElementTagNameMap[K] {
    return dressed(document.createElementNS(SVG, name), attributes, children);
}

/** A button that says what it does; `pressed` makes it a switch. */
export function button(says: string, shows: Child, attributes: Attributes = {}): HTMLButtonElement {
    return html("button", { type: "button", "aria-label": says, title: says, ...attributes }, shows);
}

export function press(of: HTMLElement, pressed: boolean): void {
    of.setAttribute("aria-pressed", String(pressed));
}

/** A drawn sign of 24 by 24. */
export function sign(d: string): SVGSVGElement {
    return svg("svg", { class: "sign", viewBox: "0 0 24 24", "aria-hidden": "true" }, svg("path", { d }));
}

/** A choice; an entry without a value is the head of a group. */
export function choice(says: string, entries: readonly [value: string, shown: string][], attributes: Attributes = {}): HTMLSelectElement {
    const select = html("select", { "aria-label": says, ...attributes });
    fill(select, entries);
    return select;
}

/** Gives a choice other entries; what was chosen stays if it is among them. */
export function fill(select: HTMLSelectElement, entries: readonly [value: string, shown: string][]): void {
    const was = select.value;
    let into: HTMLElement = select;
    select.replaceChildren();
    for (const [value, shown] of entries) {
        if (value === HEAD) {
            into = html("optgroup", { label: shown });
            select.append(into);
        } else {
            into.append(html("option", { value }, shown));
        }
    }
    if (entries.some(([value]) => value === was)) select.value = was;
}

/** The value of an entry that is a group's head. */
export const HEAD = "\u0000";
