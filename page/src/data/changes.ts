// Values that are told by what makes them of another one.

import type { Changes } from "./format.ts";

/** A value with changes; what does not change is shared. */
export function changed<T>(from: T, changes: Changes): T {
    if (Array.isArray(changes)) return changes[0] as T;
    const made = (Array.isArray(from) ? [...from] : { ...from }) as Record<string, unknown>;
    for (const [key, change] of Object.entries(changes)) made[key] = changed(made[key], change);
    return made as T;
}
