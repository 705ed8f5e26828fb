import { intoFile, keptFile, newFile } from '../files/output_file.ts';
import type { Model } from '../model.ts';
import { Problem } from '../texts/message.ts';
import { PngStream, type TakeBytes } from './png_stream.ts';

/** As the program has it (client/render/raster_setup.hpp). */
const mostPixelsASide = 65_000;
/** Up to here a picture is drawn on the canvas, in one piece. */
const onePieceSide = 4096;
/** Of parts, as far as the graphics system goes; of rows of them, 64 MB. */
const partWidth = 1536, partHeight = 768, bandPixels = 1 << 24;
/** What a style may say (client/core/json.cpp). */
const mostSize = 1000;
const mostRadius = 100;

export interface Size {
    width: number;
    height: number;
}
export interface PictureListener {
    signal: AbortSignal;
    /** 0..1, of what is drawn. */
    progress?(share: number): void;
}
/** Of a picture that a program asks for: without a size that of the page. */
export interface PictureOptions extends Partial<Size>, Partial<PictureListener> {}

/** The viewer's picture while it has the size of a file. */
export class HeldPicture {
    /** `partSide`: of parts that it is drawn in; 0: it is on the canvas. */
    constructor(
        private readonly model: Model,
        readonly size: Size,
        private readonly partSide: number,
    ) {}

    /** As a PNG, once all that it shows is here; false: it was given up, and `png` is of no use any more. */
    async write(png: PngStream, take: TakeBytes, { signal, progress }: PictureListener): Promise<boolean> {
        const isOver = (): boolean => signal.aborted || this.model.isDisposed;
        await Promise.race([this.model.frames.settled(), aborted(signal)]);
        if (isOver()) return false;
        png.begin(this.size.width, this.size.height, take);
        for await (const rows of this.bands(isOver, progress)) await png.append(rows);
        if (isOver()) return false;
        await png.finish();
        return true;
    }

    /** Its rows from the top, four bytes a pixel. */
    private async *bands(isOver: () => boolean, progress?: (share: number) => void): AsyncGenerator<Uint8Array<ArrayBuffer>> {
        const { model, partSide } = this, { width, height } = this.size;
        if (partSide === 0) {
            yield model.surface.readPixels().rgba;
            return progress?.(1);
        }
        const { viewer } = model.surface;
        const rows = Math.min(partHeight, partSide, Math.floor(bandPixels / width));
        for (let top = 0; top < height; top += rows) {
            const count = Math.min(rows, height - top), band = new Uint8Array(4 * width * count);
            for (let left = 0; left < width; left += partSide) {
                if (isOver()) return;
                if (model.isContextLost) throw new Problem('page.contextLost');
                const columns = Math.min(partSide, width - left);
                const part = viewer.drawPart(left, height - top - count, columns, count);
                for (let y = 0; y < count; y++)
                    band.set(part.subarray(4 * columns * (count - 1 - y), 4 * columns * (count - y)), 4 * (width * y + left));
                progress?.((top + (count * (left + columns)) / width) / height);
                await new Promise((resolve) => setTimeout(resolve)); // the page lives meanwhile
            }
            yield band;
        }
        viewer.resize(width, height, true); // the next may be another
    }
}

/**
 * Does something while the picture has another size, in pixels; points and shadows grow with its height, so that it looks
 * as on the page. The page's own comes back afterwards, whatever happens. Throws what is wrong with the size.
 */
export async function withSize<T>(model: Model, size: Size, work: (picture: HeldPicture) => Promise<T>): Promise<T> {
    checkSize(size);
    const { surface } = model, { canvas, viewer } = surface, { width, height } = size;
    if (surface.held) throw new Problem('picture.busy');
    const side = largestPiece(canvas), style = viewer.style(), factor = height / canvas.height;
    let inParts = Math.max(width, height) > side;
    try {
        surface.hold(size, inParts);
        const { drawingBufferWidth, drawingBufferHeight } = canvas.getContext('webgl2')!;
        if (!inParts && (drawingBufferWidth !== width || drawingBufferHeight !== height)) {
            inParts = true; // the canvas holds less than it should
            surface.letGo(model.frames);
            surface.hold(size, inParts);
        }
        if (factor !== 1)
            viewer.setStyle({
                sizePixels: Math.min(mostSize, style.sizePixels * factor),
                minSizePixels: Math.min(mostSize, style.minSizePixels * factor),
                maxSizePixels: Math.min(mostSize, style.maxSizePixels * factor),
                edl: { radiusPixels: Math.min(mostRadius, style.edl.radiusPixels * factor) },
            });
        viewer.refineAtRest();
        return await work(new HeldPicture(model, size, inParts ? Math.min(partWidth, side) : 0));
    } finally {
        if (!model.isDisposed) {
            viewer.setStyle(style);
            surface.letGo(model.frames);
        }
    }
}

/** The picture as a file of the person's, where it is large enough for the disk as it comes. */
export async function savePicture(model: Model): Promise<void> {
    const size = model.pictureSize(), name = 'picture.png', abort = new AbortController();
    checkSize(size);
    const isLarge = Math.max(size.width, size.height) > largestPiece(model.surface.canvas);
    if (model.making || model.surface.held) throw new Problem('picture.busy');
    const show = (share: number): void => {
        model.making = { share, cancel: () => abort.abort() };
        model.changed();
    };
    show(0);
    try {
        await intoFile(model, name, isLarge ? newFile : keptFile, (file) =>
            intoStream(model, size, (bytes) => file.write(bytes), { signal: abort.signal, progress: show }),
        );
    } finally {
        model.making = undefined;
        model.changed();
    }
}

/** For a program: the picture as a PNG. Rejects with the signal's reason when it was given up. */
export async function pictureBlob(model: Model, options: PictureOptions): Promise<Blob> {
    const pieces: Blob[] = [];
    await pictureInto(model, (bytes) => Promise.resolve(void pieces.push(new Blob([bytes]))), options);
    return new Blob(pieces, { type: 'image/png' });
}

/** The same, its bytes as they come. */
export async function pictureInto(model: Model, take: TakeBytes, options: PictureOptions): Promise<void> {
    const { canvas } = model.surface, aspect = canvas.width / canvas.height;
    const width = options.width ?? (options.height ? Math.max(1, Math.round(options.height * aspect)) : canvas.width);
    const height = options.height ?? Math.max(1, Math.round(width / aspect));
    const { signal = new AbortController().signal, progress } = options;
    const isWhole =
        options.width === undefined && options.height === undefined
            ? await asItIs(model, take)
            : await intoStream(model, { width, height }, take, { signal, ...(progress && { progress }) });
    if (!isWhole) throw signal.reason;
}

/** The page's own picture, as far as it is here. */
async function asItIs(model: Model, take: TakeBytes): Promise<boolean> {
    const { width, height, rgba } = model.surface.readPixels();
    return withPng(async (png) => {
        png.begin(width, height, take);
        await png.append(rgba);
        await png.finish();
        return true;
    });
}

function intoStream(model: Model, size: Size, take: TakeBytes, listener: PictureListener): Promise<boolean> {
    return withPng((png) => withSize(model, size, (picture) => picture.write(png, take, listener)));
}

export async function withPng<T>(work: (png: PngStream) => Promise<T>): Promise<T> {
    const png = new PngStream();
    try {
        return await work(png);
    } finally {
        png.stop();
    }
}

function checkSize({ width, height }: Size): void {
    const isSide = (side: number): boolean => Number.isInteger(side) && side >= 1 && side <= mostPixelsASide;
    if (!isSide(width) || !isSide(height)) throw new Problem('picture.size', { most: mostPixelsASide });
}

function largestPiece(canvas: HTMLCanvasElement): number {
    const gl = canvas.getContext('webgl2')!;
    return Math.min(onePieceSide, (gl.getParameter(gl.MAX_TEXTURE_SIZE) as number | null) ?? onePieceSide);
}

function aborted(signal: AbortSignal): Promise<void> {
    return new Promise((resolve) => {
        if (signal.aborted) resolve();
        else signal.addEventListener('abort', () => resolve(), { once: true });
    });
}
