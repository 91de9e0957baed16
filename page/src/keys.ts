// Keys of the whole page. Those that something with the focus takes for itself are left to it.

const TAKES_ALL = "input:not([type=range], [type=checkbox]), textarea, select, [contenteditable]";
const TAKES_SPACE = "button, summary, a[href], input[type=checkbox]";
/** Arrows, Home and End belong to a slider of its own, but for that of time, and to what scrolls. */
const TAKES_ARROWS = "input[type=range]:not(.scrub input), [role=tab]";
const SCROLLS = ".sheet, .plot-list, .results";

export function keys(deeds: Record<string, () => void>): void {
    addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
        const at = event.target instanceof Element ? event.target : document.body;
        if (at.closest("dialog") || at.closest(TAKES_ALL)) return;
        if (event.key === " " && at.closest(TAKES_SPACE)) return;
        const moves = event.key.startsWith("Arrow") || event.key === "Home" || event.key === "End";
        if (moves && (at.closest(TAKES_ARROWS) || at.matches(SCROLLS))) return;
        const letter = event.key.length === 1 ? event.key.toLowerCase() : event.key;
        const name = event.shiftKey && moves ? `Shift ${event.key}` : letter === "=" ? "+" : letter === "_" || letter === "−" ? "-" : letter;
        const deed = deeds[name];
        if (!deed) return;
        event.preventDefault();
        deed();
    });
}
