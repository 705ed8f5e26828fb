import type { ScreenPolygon, Vector } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import { Problem } from '../texts/message.ts';
import type { Frames } from './frames.ts';

/** As the program has it (client/render/raster_setup.hpp), and as many pixels as a page can hold several times. */
const mostPixelsASide = 16384;
const mostPixels = 100e6;
/** What a style may say (client/core/json.cpp). */
const mostSize = 1000;
const mostRadius = 100;

/** The canvas that is drawn on: its size, its graphics context, its pixels. Places are CSS pixels of it. */
export class Surface {
    private readonly stopping = new AbortController();
    private sizes: ResizeObserver | undefined;
    /** The picture has another size than the canvas on the page, for a file. */
    private isHeld = false;

    constructor(
        readonly canvas: HTMLCanvasElement,
        private readonly viewer: Viewer,
    ) {}

    /** Pixels of the picture to one CSS pixel. */
    get pixelRatio(): number {
        return this.canvas.clientWidth > 0 ? this.canvas.width / this.canvas.clientWidth : 1;
    }

    /** From now on the picture has the canvas's size; the browser may take the graphics context and give it back. */
    follow(frames: Frames, context: { lost: () => void; restored: () => void }): void {
        const { signal } = this.stopping;
        this.sizes = new ResizeObserver(() => {
            if (!this.isHeld) this.fill(frames);
        });
        this.sizes.observe(this.canvas);
        const lost = (event: Event): void => {
            event.preventDefault(); // so that it is given back
            this.viewer.contextLost();
            context.lost();
        };
        this.canvas.addEventListener('webglcontextlost', lost, { signal });
        this.canvas.addEventListener('webglcontextrestored', context.restored, { signal });
    }

    /** Gives the graphics context back; the canvas is of no use any more. */
    release(): void {
        this.sizes?.disconnect();
        this.stopping.abort();
        this.canvas.getContext('webgl2')?.getExtension('WEBGL_lose_context')?.loseContext();
    }

    /** The size that it has on the page. */
    private fill(frames: Frames): void {
        const { clientWidth, clientHeight } = this.canvas;
        const ratio = window.devicePixelRatio || 1;
        this.resize(Math.max(1, Math.round(clientWidth * ratio)), Math.max(1, Math.round(clientHeight * ratio)));
        // Setting the size clears the canvas: draw before the browser shows it.
        this.viewer.redraw();
        frames.draw();
    }

    private resize(width: number, height: number): void {
        this.canvas.width = width;
        this.canvas.height = height;
        this.viewer.resize(width, height);
    }

    /**
     * Does something while the picture has another size, in pixels; points and shadows grow with its height, so that it looks
     * as on the page. The page's own comes back afterwards, whatever happens. Throws what is wrong with the size.
     */
    async withSize<T>(width: number, height: number, frames: Frames, work: () => Promise<T>): Promise<T> {
        this.check(width, height);
        if (this.isHeld) throw new Problem('picture.busy');
        const style = this.viewer.style(), factor = height / this.canvas.height;
        this.isHeld = true;
        this.canvas.style.pointerEvents = 'none'; // the view stays as it is
        this.canvas.style.objectFit = 'contain'; // and is shown with its own sides
        try {
            this.resize(width, height);
            const { drawingBufferWidth, drawingBufferHeight } = this.canvas.getContext('webgl2')!;
            if (drawingBufferWidth !== width || drawingBufferHeight !== height)
                throw new Problem('picture.graphics', { width: drawingBufferWidth, height: drawingBufferHeight });
            if (factor !== 1)
                this.viewer.setStyle({
                    sizePixels: Math.min(mostSize, style.sizePixels * factor),
                    minSizePixels: Math.min(mostSize, style.minSizePixels * factor),
                    maxSizePixels: Math.min(mostSize, style.maxSizePixels * factor),
                    edl: { radiusPixels: Math.min(mostRadius, style.edl.radiusPixels * factor) },
                });
            this.viewer.refineAtRest();
            return await work();
        } finally {
            this.viewer.setStyle(style);
            this.canvas.style.pointerEvents = this.canvas.style.objectFit = '';
            this.isHeld = false;
            this.fill(frames);
        }
    }

    private check(width: number, height: number): void {
        const isSide = (side: number): boolean => Number.isInteger(side) && side >= 1 && side <= mostPixelsASide;
        if (!isSide(width) || !isSide(height) || width * height > mostPixels)
            throw new Problem('picture.size', { most: mostPixelsASide, megapixels: mostPixels / 1e6 });
    }

    /** Where world positions are in the picture; null for what is behind the camera. */
    project(positions: Vector[]): ({ x: number; y: number } | null)[] {
        const { width, height, clientWidth, clientHeight } = this.canvas;
        const ratio = this.isHeld ? Math.max(width / clientWidth, height / clientHeight) : this.pixelRatio;
        const [left, top] = this.isHeld ? [(clientWidth - width / ratio) / 2, (clientHeight - height / ratio) / 2] : [0, 0];
        return this.viewer.project(positions).map((at) => at && { x: left + at[0] / ratio, y: top + at[1] / ratio });
    }

    /** What a polygon on the picture reaches into. */
    screenPolygon(corners: { x: number; y: number }[]): ScreenPolygon {
        const ratio = this.pixelRatio;
        return this.viewer.screenPolygon(corners.map(({ x, y }) => [x * ratio, y * ratio]));
    }

    /** The picture as it is, drawn once more: rows from the top, four bytes a pixel. */
    readPixels(): { width: number; height: number; rgba: Uint8Array } {
        const { width, height } = this.canvas;
        this.viewer.redraw();
        this.viewer.frame();
        const gl = this.canvas.getContext('webgl2')!;
        const upwards = new Uint8Array(width * height * 4);
        gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, upwards);
        const rgba = new Uint8Array(upwards.length);
        for (let y = 0; y < height; y++)
            rgba.set(upwards.subarray((height - 1 - y) * width * 4, (height - y) * width * 4), y * width * 4);
        return { width, height, rgba };
    }

    /** The picture as a PNG. */
    async picture(): Promise<Blob> {
        const { width, height, rgba } = this.readPixels();
        const canvas = new OffscreenCanvas(width, height);
        canvas.getContext('2d')!.putImageData(new ImageData(new Uint8ClampedArray(rgba), width, height), 0, 0);
        return canvas.convertToBlob({ type: 'image/png' });
    }
}
