import type { ScreenPolygon, Vector } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import type { Frames } from './frames.ts';

/** The canvas that is drawn on: its size, its graphics context, its pixels. Places are CSS pixels of it. */
export class Surface {
    private readonly stopping = new AbortController();
    private sizes: ResizeObserver | undefined;
    /** Of a picture for a file, which has another size than the canvas on the page; in parts: it is not on the canvas. */
    held: { width: number; height: number; inParts: boolean } | undefined;

    constructor(
        readonly canvas: HTMLCanvasElement,
        readonly viewer: Viewer,
    ) {}

    /** Pixels of the picture to one CSS pixel. */
    get pixelRatio(): number {
        return this.canvas.clientWidth > 0 ? this.canvas.width / this.canvas.clientWidth : 1;
    }

    /** From now on the picture has the canvas's size; the browser may take the graphics context and give it back. */
    follow(frames: Frames, context: { lost: () => void; restored: () => void }): void {
        const { signal } = this.stopping;
        this.sizes = new ResizeObserver(() => {
            if (!this.held) this.fill(frames);
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

    /** From now on the picture has another size, and the view stays as it is. */
    hold(size: { width: number; height: number }, inParts: boolean): void {
        this.held = { ...size, inParts };
        this.canvas.style.pointerEvents = 'none';
        this.canvas.style.objectFit = 'contain'; // and is shown with its own sides
        if (inParts) this.viewer.resize(size.width, size.height, true);
        else this.resize(size.width, size.height);
    }
    /** It is the page's again. */
    letGo(frames: Frames): void {
        this.held = undefined;
        this.canvas.style.pointerEvents = this.canvas.style.objectFit = '';
        this.fill(frames);
    }

    /** Where world positions are in the picture; null for what is behind the camera. */
    project(positions: Vector[]): ({ x: number; y: number } | null)[] {
        const { clientWidth, clientHeight } = this.canvas, { width = 0, height = 0, inParts = false } = this.held ?? {};
        const ratio = !this.held ? this.pixelRatio : Math.max(inParts ? 0 : width / clientWidth, height / clientHeight);
        const [left, top] = this.held ? [(clientWidth - width / ratio) / 2, (clientHeight - height / ratio) / 2] : [0, 0];
        return this.viewer.project(positions).map((at) => at && { x: left + at[0] / ratio, y: top + at[1] / ratio });
    }

    /** What a polygon on the picture reaches into. */
    screenPolygon(corners: { x: number; y: number }[]): ScreenPolygon {
        const ratio = this.pixelRatio;
        return this.viewer.screenPolygon(corners.map(({ x, y }) => [x * ratio, y * ratio]));
    }

    /** The picture as it is, drawn once more: rows from the top, four bytes a pixel. */
    readPixels(): { width: number; height: number; rgba: Uint8Array<ArrayBuffer> } {
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
}
