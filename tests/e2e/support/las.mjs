// LAS files, read by their specification (ASPRS LAS 1.4): integers of the points, and their records as they are.
import { readFile } from 'node:fs/promises';

/** {format, scale, offset, points: [[x, y, z], …] integers, placeOf(point), records(): hexadecimal without the place} */
export async function readLas(path) {
    const bytes = await readFile(path);
    if (bytes.toString('latin1', 0, 4) !== 'LASF') throw new Error(`${path} is no LAS file`);
    const start = bytes.readUInt32LE(96), format = bytes[104] & 0x3f, length = bytes.readUInt16LE(105);
    const is14 = bytes[25] >= 4;
    const count = is14 ? Number(bytes.readBigUInt64LE(247)) : bytes.readUInt32LE(107);
    const vector = (at) => [0, 8, 16].map((axis) => bytes.readDoubleLE(at + axis));
    const scale = vector(131), offset = vector(155);
    if (bytes.length < start + count * length) throw new Error(`${path} ends before its points do`);
    const points = Array.from({ length: count }, (_, i) =>
        [0, 4, 8].map((axis) => bytes.readInt32LE(start + i * length + axis)),
    );
    return {
        format,
        scale,
        offset,
        points,
        placeOf: (p) => p.map((value, axis) => offset[axis] + scale[axis] * value),
        records: () =>
            points.map((_, i) => bytes.toString('hex', start + i * length, start + (i + 1) * length)),
    };
}
