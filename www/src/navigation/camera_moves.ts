import type { Model } from '../model.ts';
import type { Camera, Keyframe, NamedView, Projection, Vector } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import { CameraHistory } from './camera_history.ts';

/** A camera that has rested so long can be gone back to. */
const rememberPauseMs = 500;
/** How long a flight takes. */
const flightMs = 800;

/** All that moves the camera: steps, views, flights; and where it has rested. Steps are CSS pixels of the canvas. */
export class CameraMoves {
    readonly history = new CameraHistory();
    isFlying = false;
    /** The flight goes away from a place to come back to, not to one. */
    private isLeaving = false;
    private lastFlight = 0;
    private rememberTimer: ReturnType<typeof setTimeout> | undefined;

    constructor(
        private readonly model: Model,
        private readonly viewer: Viewer,
    ) {}

    read(): Camera {
        return this.viewer.camera();
    }
    /** The path that followTrack() goes along; throws what is wrong with it. */
    setTrack(keyframes: Keyframe[]): void {
        this.viewer.setTrack(keyframes);
    }
    followTrack(seconds: number): void {
        this.step(() => this.viewer.followTrack(seconds));
    }
    /** For a picture that is to be settled: as a camera at rest. */
    placeOnTrack(seconds: number): void {
        this.viewer.followTrack(seconds);
        this.viewer.refineAtRest();
        this.model.wake();
    }
    /** The fields of client/core/camera.hpp; absent ones stay. */
    change(change: object): void {
        this.model.frames.move();
        this.model.act(() => this.viewer.setCamera(change));
        this.rememberSoon();
    }
    /** The same; what is wrong with it is thrown. */
    set(change: object): void {
        this.model.frames.move();
        this.model.change(() => this.viewer.setCamera(change));
        this.rememberSoon();
    }
    showView(view: NamedView): void {
        this.model.act(() => this.viewer.showView(view));
        this.rememberSoon();
    }
    setProjection(projection: Projection): void {
        this.model.act(() => this.viewer.setProjection(projection));
        this.rememberSoon();
    }

    orbit(dx: number, dy: number): void {
        this.step((ratio) => this.viewer.orbit(dx * ratio, dy * ratio));
    }
    pan(dx: number, dy: number): void {
        this.step((ratio) => this.viewer.pan(dx * ratio, dy * ratio));
    }
    zoom(factor: number, x: number, y: number): void {
        this.step((ratio) => this.viewer.zoom(factor, x * ratio, y * ratio));
    }
    orbitAbout(pivot: Vector, dx: number, dy: number): void {
        this.step((ratio) => this.viewer.orbitAbout(pivot, dx * ratio, dy * ratio));
    }
    dragGround(grabbed: Vector, x: number, y: number): void {
        this.step((ratio) => this.viewer.dragGround(grabbed, x * ratio, y * ratio));
    }
    dragAtDepth(grabbed: Vector, x: number, y: number): void {
        this.step((ratio) => this.viewer.dragAtDepth(grabbed, x * ratio, y * ratio));
    }
    zoomToPoint(point: Vector, factor: number): void {
        this.step(() => this.viewer.zoomToPoint(point, factor));
    }
    lookAround(dx: number, dy: number): void {
        this.step((ratio) => this.viewer.lookAround(dx * ratio, dy * ratio));
    }
    /** World units; `level`: forward along the ground. */
    walk(forward: number, right: number, up: number, level: boolean): void {
        this.step(() => this.viewer.walk(forward, right, up, level));
    }

    /** To where the point is in the middle, at a part of the distance. */
    flyToPoint(point: Vector, part: number): Promise<void> {
        this.rememberNow();
        this.isLeaving = true;
        return this.fly(this.viewer.flyToPoint(point, part));
    }
    /** To where all of the cloud shows; of all clouds without an id. */
    flyToCloud(id = 0): Promise<void> {
        this.rememberNow();
        this.isLeaving = true;
        return this.fly(this.viewer.flyToCloud(id));
    }
    flyToCamera(camera: object): Promise<void> {
        this.isLeaving = false;
        this.viewer.flyToCamera(camera);
        return this.fly(1);
    }

    back(): void {
        this.rememberNow();
        const camera = this.isFlying && this.isLeaving ? this.history.here : this.history.back();
        if (camera) void this.flyToCamera(camera);
    }
    forward(): void {
        const camera = this.history.forward();
        if (camera) void this.flyToCamera(camera);
    }

    /** No flight goes on. */
    stop(): void {
        this.lastFlight++;
        clearTimeout(this.rememberTimer);
    }

    /** Once the camera has rested for a while, it can be gone back to. */
    rememberSoon(): void {
        clearTimeout(this.rememberTimer);
        this.rememberTimer = setTimeout(() => {
            if (this.isFlying) return this.rememberSoon(); // its frames are far apart
            this.history.rest(this.viewer.camera());
            this.model.dispatchEvent(new Event('rest'));
            this.model.changed();
        }, rememberPauseMs);
    }

    /** Where one was before a flight can be gone back to, however short one was there. */
    private rememberNow(): void {
        if (!this.isFlying) this.history.rest(this.viewer.camera());
    }

    private step(change: (pixelRatio: number) => void): void {
        this.model.frames.move();
        change(this.model.surface.pixelRatio);
        this.model.wake();
        this.rememberSoon();
    }

    private async fly(length: number): Promise<void> {
        if (length === 0) return;
        const start = performance.now();
        const duration = matchMedia('(prefers-reduced-motion: reduce)').matches ? 0 : flightMs;
        const flight = ++this.lastFlight; // a later one takes its place
        this.isFlying = true;
        for (let t = 0, goesOn = true; goesOn && t < 1;) {
            const now = await new Promise<number>((resolve) => requestAnimationFrame(resolve));
            if (flight !== this.lastFlight) return;
            t = duration === 0 ? 1 : Math.min(1, Math.max(0, now - start) / duration);
            this.step(() => (goesOn = this.viewer.fly(t)));
        }
        this.isFlying = false;
    }
}
