/**
 * Bytes of clouds' files that stay in the browser beyond the page (IndexedDB, of the page's origin). They belong to a
 * version of a file (address, strong ETag, size) and lie in pieces at multiples of 64 KiB, each with what was fetched
 * of it. Bounded in bytes: files go whole, the least recently opened first. What the browser refuses is done without.
 */

const pieceBytes = 1 << 16;
const name = 'stipple-ranges';

interface FileRecord {
    id?: number;
    url: string;
    etag: string;
    sizeBytes: number;
    /** When it was opened last, and the bytes that are here. */
    used: number;
    storedBytes: number;
}
interface Extent {
    at: number;
    bytes: Uint8Array<ArrayBuffer>;
}

/** Some of a span: from `at` to before `end`; without bytes it is a gap. */
export interface Part {
    at: number;
    end: number;
    bytes?: Uint8Array<ArrayBuffer>;
}

export class StoredRanges {
    private constructor(
        private readonly database: IDBDatabase,
        private readonly mostBytes: number,
    ) {}

    /** Undefined where the browser has no room for it. */
    static async open(mostBytes: number): Promise<StoredRanges | undefined> {
        try {
            const request = indexedDB.open(name, 1);
            request.onupgradeneeded = () => {
                request.result.createObjectStore('files', { keyPath: 'id', autoIncrement: true });
                request.result.createObjectStore('pieces');
            };
            return new StoredRanges(await answerOf(request), mostBytes);
        } catch {
            return undefined;
        }
    }

    /** What is here of that version, and where more of it goes. Other versions of the address are forgotten. */
    async version(url: string, etag: string, sizeBytes: number): Promise<StoredFile> {
        const change = this.database.transaction(['files', 'pieces'], 'readwrite');
        const files = change.objectStore('files');
        let record: FileRecord | undefined;
        for (const known of (await answerOf(files.getAll())) as FileRecord[]) {
            if (known.url !== url) continue;
            if (known.etag === etag && known.sizeBytes === sizeBytes) record = known;
            else forget(change, known);
        }
        const wasKnown = record !== undefined;
        record = { ...(record ?? { url, etag, sizeBytes, storedBytes: 0 }), used: Date.now() };
        record.id = (await answerOf(files.put(record))) as number;
        return new StoredFile(this.database, record.id, etag, sizeBytes, wasKnown, (bytes) => this.makeRoom(record.id!, bytes));
    }

    /** Lets other files go until so many bytes more fit; false if they don't. */
    private async makeRoom(keptId: number, added: number): Promise<boolean> {
        const change = this.database.transaction(['files', 'pieces'], 'readwrite');
        const files = (await answerOf(change.objectStore('files').getAll())) as FileRecord[];
        let bytes = files.reduce((sum, file) => sum + file.storedBytes, added);
        for (const file of files.filter(({ id }) => id !== keptId).sort((a, b) => a.used - b.used)) {
            if (bytes <= this.mostBytes) break;
            bytes -= file.storedBytes;
            forget(change, file);
        }
        return bytes <= this.mostBytes;
    }
}

/** One version of a file. */
export class StoredFile {
    private isFull = false;
    private keeping: Promise<void> = Promise.resolve();

    constructor(
        private readonly database: IDBDatabase,
        private readonly id: number,
        readonly etag: string,
        readonly sizeBytes: number,
        /** Something of it was stored by an earlier visit. */
        readonly wasKnown: boolean,
        private readonly makeRoom: (bytes: number) => Promise<boolean>,
    ) {}

    /** The bytes from `first` to before `end`, in order: what is here, and the gaps between. */
    async parts(first: number, end: number): Promise<Part[]> {
        const [from, to] = [first, end - 1].map((at) => [this.id, Math.floor(at / pieceBytes)]);
        const pieces = this.database.transaction('pieces').objectStore('pieces');
        const extents = (await answerOf(pieces.getAll(IDBKeyRange.bound(from, to)))) as Extent[][];
        return partsOf(first, end, extents.flat());
    }

    /** Keeps them, unless there is no room. One after the other, so that room is counted once. */
    keep(first: number, bytes: Uint8Array): Promise<void> {
        this.keeping = this.keeping.then(() => this.keepNow(first, bytes)).catch(() => void (this.isFull = true));
        return this.keeping;
    }

    private async keepNow(first: number, bytes: Uint8Array): Promise<void> {
        if (this.isFull || bytes.length === 0) return;
        this.isFull = !(await this.makeRoom(bytes.length));
        if (this.isFull) return;
        const change = this.database.transaction(['files', 'pieces'], 'readwrite');
        const pieces = change.objectStore('pieces');
        let added = 0;
        for (let at = first; at < first + bytes.length; ) {
            const piece = Math.floor(at / pieceBytes);
            const end = Math.min(first + bytes.length, (piece + 1) * pieceBytes);
            const before = ((await answerOf(pieces.get([this.id, piece]))) ?? []) as Extent[];
            const after = joined(before, { at, bytes: bytes.slice(at - first, end - first) });
            added += sizeOf(after) - sizeOf(before);
            pieces.put(after, [this.id, piece]);
            at = end;
        }
        const files = change.objectStore('files');
        const record = (await answerOf(files.get(this.id))) as FileRecord | undefined;
        if (!record) return change.abort(); // another page made room
        files.put({ ...record, storedBytes: record.storedBytes + added });
        await endOf(change);
    }
}

/** A span cut into what extents (that do not overlap, in order) have of it, and the gaps between. */
export function partsOf(first: number, end: number, extents: Extent[]): Part[] {
    const parts: Part[] = [];
    let here = first;
    for (const { at, bytes } of extents) {
        const from = Math.max(here, at), to = Math.min(end, at + bytes.length);
        if (from >= to) continue;
        if (from > here) parts.push({ at: here, end: from });
        parts.push({ at: from, end: to, bytes: bytes.subarray(from - at, to - at) });
        here = to;
    }
    if (here < end) parts.push({ at: here, end });
    return parts;
}

/** Extents that neither overlap nor touch, in order, with one more. */
export function joined(extents: Extent[], added: Extent): Extent[] {
    const touches = ({ at, bytes }: Extent): boolean => at <= added.at + added.bytes.length && added.at <= at + bytes.length;
    const parts = [...extents.filter(touches), added];
    const at = Math.min(...parts.map((part) => part.at));
    const bytes = new Uint8Array(Math.max(...parts.map((part) => part.at + part.bytes.length)) - at);
    for (const part of parts) bytes.set(part.bytes, part.at - at);
    return [...extents.filter((extent) => !touches(extent)), { at, bytes }].sort((a, b) => a.at - b.at);
}

function sizeOf(extents: Extent[]): number {
    return extents.reduce((sum, { bytes }) => sum + bytes.length, 0);
}

function forget(change: IDBTransaction, { id }: FileRecord): void {
    change.objectStore('files').delete(id!);
    change.objectStore('pieces').delete(IDBKeyRange.bound([id!, 0], [id!, Infinity]));
}

function answerOf<T>(request: IDBRequest<T>): Promise<T> {
    return new Promise((resolve, reject) => {
        request.onsuccess = () => resolve(request.result);
        request.onerror = () => reject(request.error as Error);
    });
}
function endOf(change: IDBTransaction): Promise<void> {
    return new Promise((resolve, reject) => {
        change.oncomplete = () => resolve();
        change.onabort = () => reject(change.error as Error);
    });
}
