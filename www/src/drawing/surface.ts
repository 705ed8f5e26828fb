import type { Vector } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import type { Frames } from './frames.ts';

/** The canvas that is drawn on: its size, its graphics context, its pixels. Places are CSS pixels of it. */
export class Surface {
    private readonly stopping = new AbortController();
    private sizes: ResizeObserver | undefined;

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
            const { clientWidth, clientHeight } = this.canvas;
            const ratio = window.devicePixelRatio || 1;
            this.canvas.width = Math.max(1, Math.round(clientWidth * ratio));
            this.canvas.height = Math.max(1, Math.round(clientHeight * ratio));
            this.viewer.resize(this.canvas.width, this.canvas.height);
            // Setting the size clears the canvas: draw before the browser shows it.
            this.viewer.redraw();
            frames.draw();
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

    /** Where world positions are in the picture; null for what is behind the camera. */
    project(positions: Vector[]): ({ x: number; y: number } | null)[] {
        const ratio = this.pixelRatio;
        return this.viewer.project(positions).map((at) => at && { x: at[0] / ratio, y: at[1] / ratio });
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

    /** The picture as a PNG, in the canvas's size. */
    async picture(): Promise<Blob> {
        const { width, height, rgba } = this.readPixels();
        const canvas = new OffscreenCanvas(width, height);
        canvas.getContext('2d')!.putImageData(new ImageData(new Uint8ClampedArray(rgba), width, height), 0, 0);
        return canvas.convertToBlob({ type: 'image/png' });
    }
}
