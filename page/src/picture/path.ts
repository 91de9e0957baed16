// Paths as numbers, so that they can be scaled and stretched.

/** A command's letter with its numbers, in absolute places. */
export type Command = [letter: string, ...numbers: number[]];

/** So many numbers belong to each command. */
const TAKES: Record<string, number> = { M: 2, L: 2, H: 1, V: 1, C: 6, Q: 4, A: 7, Z: 0 };

export function parsed(d: string): Command[] {
    const commands: Command[] = [];
    const tokens = d.match(/[A-Za-z]|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?/g) ?? [];
    let letter = "";
    for (let k = 0; k < tokens.length; ) {
        if (/[A-Za-z]/.test(tokens[k]!)) letter = tokens[k++]!;
        const takes = TAKES[letter];
        if (takes === undefined) return [];
        commands.push([letter, ...tokens.slice(k, k + takes).map(Number)]);
        k += takes;
        // numbers without a letter: none behind Z
        if (takes === 0 && k < tokens.length && !/[A-Za-z]/.test(tokens[k]!)) return [];
        if (letter === "M") letter = "L";
    }
    return commands;
}

/** The path with each x and each y through a function, and radii times a factor. */
export function mapped(commands: Command[], x: (x: number) => number, y: (y: number) => number, size: number): Command[] {
    return commands.map((command): Command => {
        const [letter, ...n] = command;
        if (letter === "A") return ["A", n[0]! * size, n[1]! * size, n[2]!, n[3]!, n[4]!, x(n[5]!), y(n[6]!)];
        if (letter === "H") return ["H", x(n[0]!)];
        if (letter === "V") return ["V", y(n[0]!)];
        return [letter, ...n.map((value, k) => (k % 2 === 0 ? x(value) : y(value)))];
    });
}

/** A path whose y axis points down, as it is written, as one whose y axis points up; in other units. */
export function upright(commands: Command[], by: number): Command[] {
    const up = mapped(commands, (x) => x * by, (y) => -y * by, by);
    // arcs turn the other way round
    for (const command of up) if (command[0] === "A") command[5] = 1 - command[5]!;
    return up;
}

export function written(commands: Command[]): string {
    const number = (value: number) => String(Number(value.toFixed(3)));
    return commands.map(([letter, ...numbers]) => letter + numbers.map(number).join(" ")).join("");
}
