import type { Model } from '../model.ts';
import type { Vector } from '../wasm/values.ts';
import type { Annotation } from './annotation.ts';

/** A place counts as covered if what shows there is nearer than this part of its distance. */
const coveredPart = 0.98;
/** Parts of the distance: how near a flight comes to an annotation without a view of its own. */
const nearPart = 0.5;

/** A tour stays at each so long, and longer by a character of its text. */
const stayMs = 2000;
const readMs = 50;
const longestReadMs = 20_000;

/** The annotations of the scene. 'change' says that something did. */
export class Annotations extends EventTarget {
    items: Annotation[] = [];
    /** Whose text is open; 0: none. */
    opened = 0;
    /** The next click puts an annotation where it is. */
    isPlacing = false;
    /** Those that something hides. */
    readonly covered = new Set<number>();
    isTouring = false;
    private lastTour = 0;
    private lastId = 0;
    private isLooking = false;
    private lookAgain = false;

    constructor(private readonly model: Model) {
        super();
    }

    place(): void {
        this.isPlacing = !this.isPlacing;
        this.changed();
    }

    add(position: Vector, parent = 0): Annotation {
        const item: Annotation = {
            id: ++this.lastId,
            parent,
            title: this.model.texts.text('annotations.numbered', { number: String(this.lastId) }),
            text: '',
            position,
            hidden: false,
            maxDistance: 0,
        };
        this.items = [...this.items, item];
        this.isPlacing = false;
        this.opened = item.id;
        this.changed();
        return item;
    }

    change(id: number, change: Partial<Annotation>): void {
        if (change.parent !== undefined && this.isWithin(change.parent, id)) return; // none belongs to itself
        this.items = this.items.map((item) => (item.id === id ? { ...item, ...change } : item));
        this.changed();
    }
    /** With all that belong to it. */
    remove(id: number): void {
        this.items = this.items.filter((item) => !this.isWithin(item.id, id));
        if (!this.items.some((item) => item.id === this.opened)) this.opened = 0;
        this.changed();
    }
    open(id: number): void {
        this.opened = this.opened === id ? 0 : id;
        this.changed();
    }
    replace(items: Annotation[]): void {
        if (this.isTouring) this.endTour();
        this.items = items;
        this.lastId = Math.max(0, ...items.map((item) => item.id));
        this.opened = 0;
        this.covered.clear();
        this.changed();
    }

    /** Those of another moment. */
    restore(items: Annotation[]): void {
        if (this.isTouring) this.endTour();
        this.items = items;
        if (!this.find(this.opened)) this.opened = 0;
        this.changed();
    }

    childrenOf(id: number): Annotation[] {
        return this.items.filter((item) => item.parent === id);
    }
    find(id: number): Annotation | undefined {
        return this.items.find((item) => item.id === id);
    }

    /** Keeps the present view as the annotation's. */
    keepView(id: number): void {
        this.change(id, { camera: this.model.camera.read() });
    }
    async flyTo(id: number): Promise<void> {
        const item = this.find(id);
        if (!item) return;
        this.opened = id;
        this.changed();
        if (item.camera) await this.model.camera.flyToCamera(item.camera);
        else await this.model.camera.flyToPoint(item.position, nearPart);
    }

    /** In the order of the tree, each before those that belong to it. */
    inOrder(parent = 0): Annotation[] {
        return this.childrenOf(parent).flatMap((item) => [item, ...this.inOrder(item.id)]);
    }

    /** From one to the next of those that are not hidden, each as long as its text takes to read. */
    async tour(): Promise<void> {
        const tour = ++this.lastTour;
        this.isTouring = true;
        for (const item of this.inOrder().filter((one) => !this.isHidden(one))) {
            await this.flyTo(item.id);
            if (tour !== this.lastTour) return;
            await new Promise((resolve) => setTimeout(resolve, stayMs + Math.min(longestReadMs, readMs * item.text.length)));
            if (tour !== this.lastTour) return;
        }
        this.endTour();
    }
    endTour(): void {
        this.lastTour++;
        this.isTouring = false;
        this.changed();
    }

    private isHidden(item: Annotation): boolean {
        for (let at: Annotation | undefined = item; at; at = this.find(at.parent)) if (at.hidden) return true;
        return false;
    }

    /** Neither hidden, with one that is, nor too far away. */
    isShown(item: Annotation): boolean {
        if (this.isHidden(item)) return false;
        return item.maxDistance === 0 || this.distanceTo(item.position) <= item.maxDistance;
    }

    /** Looks which are behind something, one after the other, once the picture rests. */
    async look(): Promise<void> {
        this.lookAgain = true;
        if (this.isLooking) return;
        this.isLooking = true;
        while (this.lookAgain) {
            this.lookAgain = false;
            for (const item of this.items.filter((shown) => this.isShown(shown))) await this.lookAt(item);
        }
        this.isLooking = false;
    }

    private async lookAt(item: Annotation): Promise<void> {
        const [at] = this.model.surface.project([item.position]);
        const { clientWidth, clientHeight } = this.model.canvas;
        if (!at || at.x < 0 || at.y < 0 || at.x >= clientWidth || at.y >= clientHeight) return;
        const place = await this.model.picking.placeAside(at.x, at.y);
        if (place === undefined) return;
        const isCovered = place !== null && this.distanceTo(place) < coveredPart * this.distanceTo(item.position);
        if (isCovered === this.covered.has(item.id)) return;
        if (isCovered) this.covered.add(item.id);
        else this.covered.delete(item.id);
        this.changed();
    }

    private distanceTo(position: Vector): number {
        const camera = this.model.camera.read();
        return Math.hypot(...position.map((value, axis) => value - camera.position[axis]!));
    }
    private isWithin(id: number, ancestor: number): boolean {
        for (let at = this.find(id); at; at = this.find(at.parent)) if (at.id === ancestor) return true;
        return false;
    }
    private changed(): void {
        this.dispatchEvent(new Event('change'));
    }
}
