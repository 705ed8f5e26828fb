import { Problem } from '../texts/message.ts';

export interface ProfileRow {
    station: number;
    offset: number;
    x: number;
    y: number;
    z: number;
    colour: number;
    class: number;
    return: number;
    intensity: number;
}

/** What the server is asked for of a cloud that has it. */
export const profileAttributes = ['Red', 'Green', 'Blue', 'Classification', 'Return Number', 'Intensity'];

/** Points of a profile, column by column; `colour`: 0xAABBGGRR, as a canvas has it. */
export class ProfilePoints {
    count = 0;
    station = new Float64Array(1024);
    height = new Float64Array(1024);
    offset = new Float64Array(1024);
    x = new Float64Array(1024);
    y = new Float64Array(1024);
    colour = new Uint32Array(1024);
    classification = new Uint8Array(1024);
    returnNumber = new Uint8Array(1024);
    intensity = new Float32Array(1024);

    add(row: ProfileRow): void {
        if (this.count === this.station.length) this.grow();
        const at = this.count++;
        this.station[at] = row.station;
        this.offset[at] = row.offset;
        this.height[at] = row.z;
        this.x[at] = row.x;
        this.y[at] = row.y;
        this.colour[at] = row.colour;
        this.classification[at] = row.class;
        this.returnNumber[at] = row.return;
        this.intensity[at] = row.intensity;
    }

    /** Batches of client/region/point_taker.hpp. */
    addPiece(bytes: Uint8Array<ArrayBuffer>): void {
        const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
        for (let at = 0; at < bytes.length; ) {
            const count = view.getUint32(at, true), columns = at + 8;
            const double = (column: number, row: number): number => view.getFloat64(columns + 8 * (column * count + row), true);
            const words = columns + 40 * count;
            for (let row = 0; row < count; row++) {
                const marks = view.getUint32(words + 4 * (count + row), true);
                this.add({
                    station: double(0, row),
                    offset: double(1, row),
                    x: double(2, row),
                    y: double(3, row),
                    z: double(4, row),
                    colour: view.getUint32(words + 4 * row, true),
                    class: marks & 0xff,
                    return: (marks >> 8) & 0xff,
                    intensity: view.getFloat32(words + 4 * (2 * count + row), true),
                });
            }
            at = words + 12 * count;
        }
    }

    /** Of the heights; [0, 1] without points. */
    heights(): [number, number] {
        let low = Infinity, high = -Infinity;
        for (let i = 0; i < this.count; i++) {
            low = Math.min(low, this.height[i]!);
            high = Math.max(high, this.height[i]!);
        }
        return this.count > 0 ? [low, high] : [0, 1];
    }

    private grow(): void {
        const size = 2 * this.station.length;
        const wider = <T extends { set(from: T): void }>(old: T, Kind: new (size: number) => T): T => {
            const array = new Kind(size);
            array.set(old);
            return array;
        };
        this.station = wider(this.station, Float64Array);
        this.height = wider(this.height, Float64Array);
        this.offset = wider(this.offset, Float64Array);
        this.x = wider(this.x, Float64Array);
        this.y = wider(this.y, Float64Array);
        this.colour = wider(this.colour, Uint32Array);
        this.classification = wider(this.classification, Uint8Array);
        this.returnNumber = wider(this.returnNumber, Uint8Array);
        this.intensity = wider(this.intensity, Float32Array);
    }
}

const plainColour = 0xffc8c8c8;

/** Reads the CSV of /profile (docs/API.md) as it arrives. */
export async function readProfile(body: ReadableStream<Uint8Array>, into: ProfilePoints): Promise<void> {
    let rest = '', columns: Record<string, number> | undefined;
    const take = (line: string): void => {
        if (line === '') return;
        const fields = line.split(',');
        if (!columns) {
            columns = Object.fromEntries(fields.map((name, at) => [name.trim(), at]));
            for (const name of ['X', 'Y', 'Z', 'Station', 'Offset'])
                if (columns[name] === undefined) throw new Problem('profile.noColumn', { name });
            return;
        }
        const number = (name: string): number => Number(fields[columns![name]!]);
        const numberOr0 = (name: string): number => (columns![name] === undefined ? 0 : number(name));
        into.add({
            station: number('Station'),
            offset: number('Offset'),
            x: number('X'),
            y: number('Y'),
            z: number('Z'),
            colour: columns['Red'] === undefined ? plainColour : colourOf(number('Red'), number('Green'), number('Blue')),
            class: numberOr0('Classification'),
            return: numberOr0('Return Number'),
            intensity: numberOr0('Intensity'),
        });
    };
    const reader = body.pipeThrough(new TextDecoderStream() as unknown as ReadableWritablePair<string, Uint8Array>).getReader();
    for (;;) {
        const { done, value } = await reader.read();
        const lines = (rest + (value ?? '')).split('\n');
        rest = done ? '' : lines.pop()!;
        for (const line of lines) take(line.trimEnd());
        if (done) return;
    }
}

/** 16-bit channels, as LAS has them; files with 8-bit values in them show them as they are. */
function colourOf(red: number, green: number, blue: number): number {
    const shift = Math.max(red, green, blue) > 255 ? 8 : 0;
    return (0xff000000 | ((blue >> shift) << 16) | ((green >> shift) << 8) | (red >> shift)) >>> 0;
}
