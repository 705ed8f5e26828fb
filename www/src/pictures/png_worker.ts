// The PNG worker: pixels become a PNG row by row, in a stream of pieces. Any number of pictures, one after another.
import { crc32 } from './crc32.ts';
import type { FromPngWorker, ToPngWorker } from './png_messages.ts';

const scope = self as unknown as {
    onmessage: ((event: MessageEvent<ToPngWorker>) => void) | null;
    postMessage(message: FromPngWorker, transfer?: Transferable[]): void;
};

/** So much is deflated at a time: answers go out in between. */
const rowBytesAtOnce = 1 << 20;

let width = 0;
/** The row above, as it was before it was filtered. */
let above = new Uint8Array(0);
let deflate: WritableStreamDefaultWriter<Uint8Array<ArrayBuffer>>;
let deflated: Promise<void>;

function send(bytes: Uint8Array<ArrayBuffer>): void {
    scope.postMessage({ kind: 'bytes', bytes }, [bytes.buffer]);
}

/** Length, type, content, check sum (PNG, 5.3). */
function sendChunk(type: string, content: Uint8Array): void {
    const chunk = new Uint8Array(content.length + 12), view = new DataView(chunk.buffer);
    view.setUint32(0, content.length);
    for (let i = 0; i < 4; i++) chunk[4 + i] = type.charCodeAt(i);
    chunk.set(content, 8);
    view.setUint32(content.length + 8, crc32(chunk.subarray(4, content.length + 8)));
    send(chunk);
}

function begin(message: ToPngWorker & { kind: 'begin' }): void {
    width = message.width;
    above = new Uint8Array(3 * width);
    send(new Uint8Array([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]));
    const header = new Uint8Array(13), view = new DataView(header.buffer);
    view.setUint32(0, message.width);
    view.setUint32(4, message.height);
    header[8] = 8; // bits
    header[9] = 2; // R, G, B
    sendChunk('IHDR', header);
    sendChunk('sRGB', new Uint8Array([0])); // perceptual
    const stream = new CompressionStream('deflate');
    deflate = stream.writable.getWriter();
    deflated = passOn(stream.readable.getReader());
    deflated.catch(() => undefined); // told by finish()
}

async function passOn(from: ReadableStreamDefaultReader<Uint8Array>): Promise<void> {
    for (;;) {
        const { done, value } = await from.read();
        if (done) return;
        sendChunk('IDAT', value);
    }
}

async function append(rgba: Uint8Array): Promise<void> {
    const rows = rgba.length / (4 * width), rowBytes = 3 * width + 1;
    const atOnce = Math.max(1, Math.floor(rowBytesAtOnce / rowBytes));
    for (let first = 0; first < rows; first += atOnce) {
        const count = Math.min(atOnce, rows - first), lines = new Uint8Array(count * rowBytes);
        for (let y = 0; y < count; y++)
            filterRow(rgba.subarray(4 * width * (first + y), 4 * width * (first + y + 1)), lines.subarray(y * rowBytes, (y + 1) * rowBytes));
        await deflate.write(lines);
    }
}

/** The filter (PNG, 9) that leaves the least: none, the pixel to the left, the one above. */
function filterRow(rgba: Uint8Array, line: Uint8Array): void {
    const row = new Uint8Array(3 * width);
    for (let from = 0, to = 0; to < row.length; from += 4, to += 3) {
        row[to] = rgba[from]!;
        row[to + 1] = rgba[from + 1]!;
        row[to + 2] = rgba[from + 2]!;
    }
    let none = 0, left = 0, up = 0;
    for (let i = 0; i < row.length; i++) {
        const value = row[i]!;
        none += size(value);
        left += size(value - (i < 3 ? 0 : row[i - 3]!));
        up += size(value - above[i]!);
    }
    const filter = up <= left && up <= none ? 2 : left <= none ? 1 : 0;
    line[0] = filter;
    for (let i = 0; i < row.length; i++) line[i + 1] = row[i]! - (filter === 2 ? above[i]! : filter === 1 && i >= 3 ? row[i - 3]! : 0);
    above = row;
}
/** Of a difference modulo 256. */
function size(difference: number): number {
    return Math.abs((difference << 24) >> 24);
}

async function finish(): Promise<void> {
    await deflate.close();
    await deflated;
    sendChunk('IEND', new Uint8Array(0));
}

async function handle(message: ToPngWorker): Promise<void> {
    try {
        if (message.kind === 'begin') begin(message);
        else if (message.kind === 'rows') await append(message.rgba);
        else await finish();
        scope.postMessage({ kind: 'done' });
    } catch (error) {
        scope.postMessage({ kind: 'failed', sentence: error instanceof Error ? error.message : String(error) });
    }
}

let before: Promise<void> = Promise.resolve();
scope.onmessage = (event) => {
    before = before.then(() => handle(event.data)); // in the order in which they came
};
