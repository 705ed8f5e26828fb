import type { Model } from '../model.ts';
import { Questions, type Reply } from './questions.ts';
import type { PickedPoint, Vector } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';

/** What is under the pointer. Places and radii are CSS pixels of the canvas. 'pick': a person asked. */
export class Picking extends EventTarget {
    /** The point that was asked about last. */
    point: PickedPoint | null = null;
    private readonly questions = new Questions();

    constructor(
        private readonly model: Model,
        private readonly viewer: Viewer,
    ) {
        super();
    }

    /** The place shown there, in world coordinates, without anything being read; null if there is none. */
    place(x: number, y: number, radius = 8): Promise<Vector | null> {
        return this.questions.ask(() => this.begin(x, y, radius), () => this.placeReply());
    }
    /** The same for what the page asks by itself; undefined if a person asked something else meanwhile. */
    placeAside(x: number, y: number, radius = 2): Promise<Vector | null | undefined> {
        return this.questions.askAside(() => this.begin(x, y, radius), () => this.placeReply());
    }
    /** The point shown there, with all its attributes; null if there is none. */
    pick(x: number, y: number, radius = 8): Promise<PickedPoint | null> {
        return this.questions.ask(
            () => this.begin(x, y, radius),
            () => {
                const { pending, point, error } = this.viewer.takePick();
                if (pending) this.model.wake(); // what has to be read is asked for between frames
                return { pending, ...(point && { value: point }), ...(error !== undefined && { error }) };
            },
        );
    }

    /** Shows what is known of the point there, or that there is none. */
    async show(x: number, y: number): Promise<void> {
        try {
            this.point = await this.pick(x, y);
            this.dispatchEvent(new Event('pick'));
        } catch (error) {
            this.model.tell(error);
        }
        this.model.changed();
    }
    forget(): void {
        this.point = null;
        this.model.changed();
    }

    /** Whoever waits for an answer gets null. */
    stop(): void {
        this.questions.stop();
    }

    private begin(x: number, y: number, radius: number): void {
        const ratio = this.model.surface.pixelRatio;
        this.viewer.pick(x * ratio, y * ratio, Math.round(radius * ratio));
    }
    private placeReply(): Reply<Vector> {
        const { pending, place, error } = this.viewer.takePlace();
        return { pending, ...(place && { value: place }), ...(error !== undefined && { error }) };
    }
}
