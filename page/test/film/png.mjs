// Pictures with few colours, still or moving (PNG, and APNG of several frames: W3C, PNG third edition). Of each frame stands in the file
// what is not as in the one before; what is, is transparent.

import { crc32, deflateSync, inflateSync } from "node:zlib";

const SIGNATURE = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
const COLOURS = 255;
/** The entry of the palette behind all colours. */
const TRANSPARENT = COLOURS;

/** Pixels of a picture as browsers write it: 8 bits of red, green, blue (and alpha, which is left out), not interlaced. */
export function read(bytes) {
    const data = [];
    let [width, height, channels] = [0, 0, 0];
    for (let at = SIGNATURE.length; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) {
        const content = bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at));
        const kind = bytes.toString("latin1", at + 4, at + 8);
        if (kind === "IHDR") {
            [width, height] = [content.readUInt32BE(0), content.readUInt32BE(4)];
            channels = { 2: 3, 6: 4 }[content[9]];
            if (content[8] !== 8 || !channels || content[12] !== 0) throw new Error("not a picture of this kind");
        }
        if (kind === "IDAT") data.push(content);
    }
    const lines = inflateSync(Buffer.concat(data));
    const length = width * channels;
    let above = new Uint8Array(length);
    const pixels = new Uint32Array(width * height);
    for (let y = 0; y < height; y++) {
        const from = y * (length + 1);
        const line = lines.subarray(from + 1, from + 1 + length);
        for (let x = 0; x < length; x++) {
            const left = x < channels ? 0 : line[x - channels];
            line[x] += predicted(lines[from], left, above[x], x < channels ? 0 : above[x - channels]);
        }
        for (let x = 0; x < width; x++) {
            const [red, green, blue] = line.subarray(x * channels, x * channels + 3);
            pixels[y * width + x] = (red << 16) | (green << 8) | blue;
        }
        above = line;
    }
    return { width, height, pixels };
}

/** What a line's filter adds to a byte: nothing, the one to the left, above, their mean, or Paeth's choice. */
function predicted(filter, left, up, corner) {
    if (filter < 3) return [0, left, up][filter];
    if (filter === 3) return (left + up) >> 1;
    const [a, b, c] = [Math.abs(up - corner), Math.abs(left - corner), Math.abs(left + up - 2 * corner)];
    return a <= b && a <= c ? left : b <= c ? up : corner;
}

/** A file of frames of one size, each shown for a time (ms). */
export function written(frames) {
    const { palette, entry } = colours(frames);
    const [{ width, height }] = frames;
    const head = Buffer.from([...u32(width), ...u32(height), 8, 3, 0, 0, 0]);
    const chunks = [chunk("IHDR", head)];
    if (frames.length > 1) chunks.push(chunk("acTL", Buffer.from([...u32(frames.length), ...u32(0)])));
    chunks.push(chunk("PLTE", Buffer.from([...palette, 0].flatMap((colour) => [colour >> 16, (colour >> 8) & 255, colour & 255]))));
    if (frames.length > 1) chunks.push(chunk("tRNS", Buffer.from([...palette.map(() => 255), 0])));
    let number = 0;
    frames.forEach((frame, k) => {
        const part = k === 0 ? { x: 0, y: 0, width, height } : changed(frames[k - 1], frame);
        if (frames.length > 1) {
            const times = [frame.shown >> 8, frame.shown & 255, 1000 >> 8, 1000 & 255];
            chunks.push(chunk("fcTL", Buffer.from([...[number++, part.width, part.height, part.x, part.y].flatMap(u32), ...times, 0, 1])));
        }
        const data = deflateSync(lines(frame, part, entry, frames[k - 1]), { level: 9, memLevel: 9 });
        chunks.push(k === 0 ? chunk("IDAT", data) : chunk("fdAT", Buffer.concat([Buffer.from(u32(number++)), data])));
    });
    return Buffer.concat([SIGNATURE, ...chunks, chunk("IEND", Buffer.alloc(0))]);
}

/** The rectangle in which two frames differ; one pixel, where they do not. */
function changed(before, { width, height, pixels }) {
    let [left, top, right, bottom] = [width, height, -1, -1];
    for (let at = 0; at < pixels.length; at++) {
        if (pixels[at] === before.pixels[at]) continue;
        const [x, y] = [at % width, Math.floor(at / width)];
        [left, top, right, bottom] = [Math.min(left, x), Math.min(top, y), Math.max(right, x), Math.max(bottom, y)];
    }
    return right < 0 ? { x: 0, y: 0, width: 1, height: 1 } : { x: left, y: top, width: right - left + 1, height: bottom - top + 1 };
}

/** The lines of a part of a frame, unfiltered, as entries of the palette. */
function lines({ width: all, pixels }, { x, y, width, height }, entry, before) {
    const bytes = Buffer.alloc(height * (width + 1));
    for (let row = 0; row < height; row++) {
        for (let column = 0; column < width; column++) {
            const at = (y + row) * all + x + column;
            bytes[row * (width + 1) + 1 + column] = pixels[at] === before?.pixels[at] ? TRANSPARENT : entry(pixels[at]);
        }
    }
    return bytes;
}

/** The colours that are used most, and which of them is nearest to a colour. */
function colours(frames) {
    const uses = new Map();
    for (const { pixels } of frames) for (const colour of pixels) uses.set(colour, (uses.get(colour) ?? 0) + 1);
    const palette = [...uses].sort(([a, m], [b, n]) => n - m || a - b).slice(0, COLOURS).map(([colour]) => colour);
    while (palette.length < COLOURS) palette.push(palette[0]);
    const known = new Map(palette.map((colour, k) => [colour, k]));
    const entry = (colour) => {
        if (!known.has(colour)) {
            const away = palette.map((other) => [16, 8, 0].reduce((sum, bits) => sum + (((colour >> bits) & 255) - ((other >> bits) & 255)) ** 2, 0));
            known.set(colour, away.indexOf(Math.min(...away)));
        }
        return known.get(colour);
    };
    return { palette, entry };
}

function chunk(kind, content) {
    const named = Buffer.concat([Buffer.from(kind, "latin1"), content]);
    return Buffer.concat([Buffer.from(u32(content.length)), named, Buffer.from(u32(crc32(named)))]);
}

const u32 = (value) => [value >>> 24, (value >>> 16) & 255, (value >>> 8) & 255, value & 255];
