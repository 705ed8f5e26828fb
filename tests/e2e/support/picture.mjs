// Pictures as rows of four bytes a pixel: reading the program's PNG files, and comparing.
import { readFile } from 'node:fs/promises';
import { inflateSync } from 'node:zlib';

/** A PNG file of 8-bit RGB or RGBA without interlacing, as `stipple render` writes (PNG 3rd edition, §9). */
export async function readPng(path) {
    const file = await readFile(path);
    let header;
    const data = [];
    for (let at = 8; at < file.length; ) {
        const size = file.readUInt32BE(at);
        const kind = file.toString('latin1', at + 4, at + 8);
        const body = file.subarray(at + 8, at + 8 + size);
        if (kind === 'IHDR') header = body;
        if (kind === 'IDAT') data.push(body);
        at += size + 12;
    }
    const width = header.readUInt32BE(0);
    const height = header.readUInt32BE(4);
    const channels = { 2: 3, 6: 4 }[header[9]];
    if (header[8] !== 8 || !channels || header[12] !== 0) throw new Error(`${path}: a kind of PNG not read here`);
    return { width, height, rgba: unfilter(inflateSync(Buffer.concat(data)), width, height, channels) };
}

function unfilter(raw, width, height, channels) {
    const stride = width * channels;
    const rgba = Buffer.alloc(width * height * 4, 255);
    let above = Buffer.alloc(stride);
    for (let y = 0; y < height; y++) {
        const filter = raw[y * (stride + 1)];
        const row = Buffer.from(raw.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1)));
        for (let i = 0; i < stride; i++) {
            const a = i >= channels ? row[i - channels] : 0;
            const b = above[i];
            const c = i >= channels ? above[i - channels] : 0;
            row[i] += [0, a, b, (a + b) >> 1, paeth(a, b, c)][filter];
        }
        for (let x = 0; x < width; x++) row.copy(rgba, (y * width + x) * 4, x * channels, (x + 1) * channels);
        above = row;
    }
    return rgba;
}

function paeth(a, b, c) {
    const [pa, pb, pc] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
    return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/** How two pictures of one size differ; a pixel differs when a channel is more than `threshold` off. */
export function compare(a, b, threshold = 8) {
    if (a.width !== b.width || a.height !== b.height)
        throw new Error(`${a.width}x${a.height} can't be compared with ${b.width}x${b.height}`);
    let [differing, largest, sum] = [0, 0, 0];
    for (let at = 0; at < a.rgba.length; at += 4) {
        let most = 0;
        for (let channel = 0; channel < 3; channel++) {
            const difference = Math.abs(a.rgba[at + channel] - b.rgba[at + channel]);
            most = Math.max(most, difference);
            sum += difference;
        }
        largest = Math.max(largest, most);
        if (most > threshold) differing++;
    }
    const pixels = a.width * a.height;
    return { pixels, differing, share: differing / pixels, largest, mean: sum / pixels / 3 };
}

/** The share of pixels that are not the picture's corner colour. */
export function coverage({ rgba }) {
    let covered = 0;
    for (let at = 0; at < rgba.length; at += 4)
        if (rgba[at] !== rgba[0] || rgba[at + 1] !== rgba[1] || rgba[at + 2] !== rgba[2]) covered++;
    return (covered * 4) / rgba.length;
}
