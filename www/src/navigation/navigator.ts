import type { Model } from '../model.ts';
import type { Vector } from '../wasm/values.ts';

/**
 * orbit: drag turns around the middle. earth: drag moves the ground with the pointer, right drag turns around the place
 * under it. fly: drag looks around, keys walk. Everywhere the wheel goes to what is under the pointer.
 */
export type NavigationMode = 'orbit' | 'earth' | 'fly';

interface Place {
    x: number;
    y: number;
}

/** A wheel that rests so long, or a pointer that moves so far, asks anew what is under it. */
const wheelPauseMs = 300;
const wheelSlop = 6;
/** Part of the distance that remains after flying to a point. */
const nearPart = 0.35;
/** Part of the depth under the pointer that a walk covers in a second. */
const walkPart = 0.5;

/** Turns what pointers, wheels and keys do into steps of the camera. Places are CSS pixels of the canvas. */
export class Navigator {
    mode: NavigationMode = 'orbit';

    /** What was under the pointer when it went down; undefined: not known yet, null: nothing. */
    private grabbed: Vector | null | undefined;
    /** Where the pointer has gone while that is not known. */
    private waiting: { from: Place; to: Place; other: boolean } | undefined;
    private presses = 0;
    private wheelAt: (Place & { time: number }) | undefined;
    private wheelPoint: Vector | null | undefined;
    private pointer: Place = { x: 0, y: 0 };
    private readonly keys = new Set<string>();
    private isWalking = false;
    private walkSpeed = 1;
    private walkDepth: number | undefined;

    constructor(private readonly model: Model) {}

    /** The pointer went down. `other`: with another button, or shift. */
    press(at: Place, other: boolean): void {
        const press = ++this.presses;
        const isAsked = this.mode === 'earth' || other;
        this.grabbed = isAsked ? undefined : null;
        this.waiting = undefined;
        const know = (place: Vector | null): void => {
            if (press !== this.presses) return; // another took its place
            this.grabbed = place;
            const { waiting } = this;
            this.waiting = undefined;
            if (waiting) this.drag(waiting.from, waiting.to, waiting.other);
        };
        if (isAsked) void this.ask(at, know);
    }

    /** The pointer went on from one place to the next. Until it is known what was under it, the picture stays as it is. */
    drag(from: Place, to: Place, other: boolean): void {
        const { model } = this;
        const dx = to.x - from.x, dy = to.y - from.y;
        if (this.mode === 'fly' && !other) model.camera.lookAround(dx, dy);
        else if (this.mode === 'orbit' && !other) model.camera.orbit(dx, dy);
        else if (this.grabbed === undefined) this.waiting = { from: this.waiting?.from ?? from, to, other };
        else if (this.mode === 'earth' && other) this.turn(dx, dy);
        else if (this.grabbed === null) model.camera.pan(dx, dy);
        else if (this.mode === 'earth') model.camera.dragGround(this.grabbed, to.x, to.y);
        else model.camera.dragAtDepth(this.grabbed, to.x, to.y);
    }

    private turn(dx: number, dy: number): void {
        if (this.grabbed) this.model.camera.orbitAbout(this.grabbed, dx, dy);
        else if (this.grabbed === null) this.model.camera.orbit(dx, dy);
    }

    hover(at: Place): void {
        this.pointer = at;
    }

    wheel(factor: number, at: Place): void {
        const { model } = this;
        if (this.mode === 'fly' && this.keys.size > 0) {
            this.walkSpeed = Math.min(50, Math.max(0.02, this.walkSpeed / factor));
            return;
        }
        const now = performance.now(), last = this.wheelAt;
        const isNew = !last || now - last.time > wheelPauseMs || Math.hypot(at.x - last.x, at.y - last.y) > wheelSlop;
        this.wheelAt = isNew ? { ...at, time: now } : { ...last, time: now };
        if (isNew) {
            this.wheelPoint = undefined;
            void this.ask(at, (place) => (this.wheelPoint = place));
        }
        if (this.wheelPoint) model.camera.zoomToPoint(this.wheelPoint, factor);
        else model.camera.zoom(factor, at.x, at.y);
    }

    /** Flies to the point shown there; stays where there is none. */
    async flyTo(at: Place): Promise<void> {
        await this.ask(at, (place) => {
            if (place) void this.model.camera.flyToPoint(place, nearPart);
        });
    }

    /** True if the key walks. */
    keyDown(key: string): boolean {
        const name = key.toLowerCase();
        if (this.mode !== 'fly' || !'wasdqe'.includes(name) || name.length !== 1) return false;
        this.keys.add(name);
        if (!this.isWalking) void this.walk();
        return true;
    }
    keyUp(key: string): void {
        this.keys.delete(key.toLowerCase());
    }
    letGo(): void {
        this.keys.clear();
    }

    /** While keys are held: as fast as suits what is under the pointer, looked at again each second. */
    private async walk(): Promise<void> {
        this.isWalking = true;
        let last = performance.now(), asked = -Infinity;
        while (this.keys.size > 0 && !this.model.isDisposed) {
            if (last - asked > 1000) {
                asked = last;
                void this.ask(this.pointer, (place) => (this.walkDepth = place ? this.depthOf(place) : this.walkDepth));
            }
            const now = await new Promise<number>((resolve) => requestAnimationFrame(resolve));
            const seconds = Math.min(0.1, Math.max(0, now - last) / 1000);
            last = now;
            const way = seconds * walkPart * this.walkSpeed * (this.walkDepth ?? this.depthOfTarget());
            const along = (plus: string, minus: string): number =>
                (Number(this.keys.has(plus)) - Number(this.keys.has(minus))) * way;
            this.model.camera.walk(along('w', 's'), along('d', 'a'), along('e', 'q'), false);
        }
        this.isWalking = false;
        this.walkDepth = undefined;
    }

    private depthOf(place: Vector): number {
        const { position } = this.model.camera.read();
        return Math.hypot(...place.map((value, axis) => value - position[axis]!));
    }
    private depthOfTarget(): number {
        return this.depthOf(this.model.camera.read().target);
    }

    private async ask({ x, y }: Place, use: (place: Vector | null) => void): Promise<void> {
        try {
            use(await this.model.picking.place(x, y));
        } catch (error) {
            this.model.tell(error);
            use(null);
        }
    }
}
