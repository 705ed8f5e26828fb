import type { Viewer } from '../wasm/viewer.ts';

/** What failed is tried again after a pause, and no arrival tells when that is over: so look now and then. */
const retryPauseMs = 200;
/** So long after the last frame the camera is at rest. */
const restPauseMs = 250;

/** Of the page's time, loading between frames takes up to one part in so many. */
const loadShare = 4;

/**
 * The frame loop. It runs only after something was changed or arrived; a still picture costs nothing. What arrives is worked
 * off, and more is asked for, between frames as well: they can be long in coming where drawing is slow.
 */
export class Frames {
    /** Frames are timed while the camera moves, to hold a frame time. */
    isTimed = false;
    private isDue = false;
    private isStopped = false;
    /** The camera has not moved for a while. */
    private atRest = true;
    private restTimer: ReturnType<typeof setTimeout> | undefined;
    private lookAgainTimer: ReturnType<typeof setTimeout> | undefined;
    private loadTimer: ReturnType<typeof setTimeout> | undefined;
    /** When loading may take of the page's time again. */
    private nextLoad = 0;
    private settledWaiters: (() => void)[] = [];

    /** `done` is called after each turn of the loop: `drew` says whether the picture is a new one. */
    constructor(
        private readonly viewer: Viewer,
        private readonly done: (drew: boolean) => void,
    ) {}

    /** A frame is due. */
    wake(): void {
        if (this.isDue || this.isStopped) return;
        this.isDue = true;
        requestAnimationFrame(() => this.draw());
    }

    /** Something came that was asked for, or is to be asked for: that does not wait for the frame. */
    loadSoon(): void {
        this.wake();
        if (this.isStopped) return;
        this.loadTimer ??= setTimeout(() => this.load(), Math.max(0, this.nextLoad - performance.now()));
    }

    private load(): void {
        this.loadTimer = undefined;
        const start = performance.now();
        this.viewer.load();
        const end = performance.now();
        this.nextLoad = end + (loadShare - 1) * (end - start);
    }

    /** The camera moves. */
    move(): void {
        this.atRest = false;
    }

    /** Resolves when everything wanted has arrived and is drawn. */
    settled(): Promise<void> {
        return new Promise((resolve) => {
            this.settledWaiters.push(resolve);
            this.wake();
        });
    }

    /** For good. Whoever waits for the picture to settle waits no more. */
    stop(): void {
        this.isStopped = true;
        clearTimeout(this.restTimer);
        clearTimeout(this.lookAgainTimer);
        clearTimeout(this.loadTimer);
        this.settledWaiters.splice(0).forEach((resolve) => resolve());
    }

    /** At once, where the browser would show an empty canvas before the next frame. */
    draw(): void {
        this.isDue = false;
        if (this.isStopped) return;
        clearTimeout(this.loadTimer);
        this.loadTimer = undefined;
        const start = performance.now();
        const drew = this.viewer.frame();
        if (drew && !this.atRest && this.isTimed) this.time(start);
        clearTimeout(this.lookAgainTimer);
        if (this.viewer.settled()) this.settledWaiters.splice(0).forEach((resolve) => resolve());
        else this.lookAgainTimer = setTimeout(() => this.wake(), retryPauseMs);
        this.done(drew);
    }

    /**
     * The browser calls for the next frame when it could draw one, so that is how long this one took. Once no
     * further frame comes for a while, the camera rests.
     */
    private time(start: number): void {
        requestAnimationFrame(() => {
            if (!this.isStopped) this.viewer.frameTook((performance.now() - start) / 1000);
        });
        clearTimeout(this.restTimer);
        this.restTimer = setTimeout(() => {
            this.atRest = true; // what is drawn now may take its time
            this.viewer.refineAtRest();
            this.wake();
        }, restPauseMs);
    }
}
