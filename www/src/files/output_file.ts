import type { Model } from '../model.ts';
import { Problem } from '../texts/message.ts';
import { download } from '../ui/download.ts';

/** What TypeScript's own types lack of the File System Access API (Chromium). */
interface Handle extends FileSystemFileHandle {
    remove?(): Promise<void>;
}
type Picker = (options: { suggestedName: string }) => Promise<Handle>;
const picker = (): Picker | undefined => (window as { showSaveFilePicker?: Picker }).showSaveFilePicker;

/** Whether files go to the disk as they come. */
export function hasDisk(): boolean {
    return picker() !== undefined;
}

/** A file in the making. Whoever made one ends it by finish() or giveUp(). What goes wrong is thrown as a Problem. */
export interface OutputFile {
    write(bytes: Uint8Array<ArrayBuffer>): Promise<void>;
    /** Bytes that were written. */
    overwrite(offset: number, bytes: Uint8Array<ArrayBuffer>): Promise<void>;
    finish(): Promise<void>;
    /** Nothing of it stays. */
    giveUp(): Promise<void>;
}

/**
 * Where the browser has files on the disk, the person says where, and bytes go there as they come; elsewhere the page keeps
 * them until the file is whole, and has it downloaded. Undefined: the person wants none after all. To be called soon after a
 * click, or browsers ask nothing.
 */
export async function newFile(name: string): Promise<OutputFile | undefined> {
    const pick = picker();
    if (!pick) return new KeptFile(name);
    let handle: Handle;
    try {
        handle = await pick.call(window, { suggestedName: name });
    } catch (error) {
        if (error instanceof DOMException && error.name === 'AbortError') return undefined;
        return new KeptFile(name); // the page may not ask here: in a frame of another origin, for one
    }
    return DiskFile.create(handle);
}

/** One that the page keeps until it is whole. */
export function keptFile(name: string): Promise<OutputFile> {
    return Promise.resolve(new KeptFile(name));
}

/** Makes a file by `work`, which says whether it is whole. What was given up or failed leaves nothing, and that is told. */
export async function intoFile(
    model: Model,
    name: string,
    make: (name: string) => Promise<OutputFile | undefined>,
    work: (file: OutputFile) => Promise<boolean>,
): Promise<void> {
    try {
        const file = await make(name);
        if (file) await fill(model, name, file, work);
    } catch (error) {
        model.tell(error);
    }
}

async function fill(model: Model, name: string, file: OutputFile, work: (file: OutputFile) => Promise<boolean>): Promise<void> {
    try {
        if (await work(file)) return await file.finish();
    } catch (error) {
        await file.giveUp();
        throw error;
    }
    await file.giveUp();
    model.notify(model.texts.text('file.givenUp', { name }));
}

/** In blobs, which browsers keep on the disk where they are many. */
class KeptFile implements OutputFile {
    private readonly pieces: { offset: number; content: Blob }[] = [];
    private size = 0;

    constructor(private readonly name: string) {}

    async write(bytes: Uint8Array<ArrayBuffer>): Promise<void> {
        this.pieces.push({ offset: this.size, content: new Blob([bytes]) });
        this.size += bytes.length;
    }
    async overwrite(offset: number, bytes: Uint8Array<ArrayBuffer>): Promise<void> {
        for (const piece of this.pieces) {
            const { content } = piece, from = offset - piece.offset, to = from + bytes.length;
            if (to <= 0 || from >= content.size) continue;
            const inside = bytes.subarray(Math.max(0, -from), Math.min(bytes.length, content.size - from));
            piece.content = new Blob([content.slice(0, Math.max(0, from)), inside, content.slice(Math.min(to, content.size))]);
        }
    }
    async finish(): Promise<void> {
        download(new Blob(this.pieces.map(({ content }) => content)), this.name);
    }
    async giveUp(): Promise<void> {}
}

/** Browsers write beside the file, and put what was written in its place when it is closed. */
class DiskFile implements OutputFile {
    private size = 0;

    private constructor(
        private readonly handle: Handle,
        private readonly to: FileSystemWritableFileStream,
    ) {}

    static async create(handle: Handle): Promise<DiskFile> {
        try {
            return await told(handle, async () => new DiskFile(handle, await handle.createWritable()));
        } catch (error) {
            await removeEmpty(handle);
            throw error;
        }
    }

    async write(bytes: Uint8Array<ArrayBuffer>): Promise<void> {
        await this.overwrite(this.size, bytes);
        this.size += bytes.length;
    }
    overwrite(position: number, data: Uint8Array<ArrayBuffer>): Promise<void> {
        return told(this.handle, () => this.to.write({ type: 'write', position, data }));
    }
    finish(): Promise<void> {
        return told(this.handle, () => this.to.close());
    }
    async giveUp(): Promise<void> {
        await this.to.abort().catch(() => undefined); // it may have failed already, which leaves as little
        await removeEmpty(this.handle);
    }
}

/** The picker makes an empty file where there was none. */
async function removeEmpty(handle: Handle): Promise<void> {
    const left = await handle.getFile().catch(() => undefined);
    if (left?.size === 0) await handle.remove?.().catch(() => undefined);
}

async function told<T>(handle: FileSystemFileHandle, act: () => Promise<T>): Promise<T> {
    try {
        return await act();
    } catch (error) {
        throw new Problem('file.failed', { name: handle.name, reason: error instanceof Error ? error.message : String(error) });
    }
}
