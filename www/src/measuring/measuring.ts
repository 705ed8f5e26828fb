import type { Model } from '../model.ts';
import type { MeasureKind, PlacedPoint } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import { kindOf, type MeasuredBox, type Measurement, obstacleOf, requestOf, type VolumeBase } from './measurement.ts';
import type { DisplayUnit } from './units.ts';
import { Volumes } from './volumes.ts';

/** The measuring tools: what was measured, and the one that is being drawn. 'change' says that something did. */
export class Measuring extends EventTarget {
    items: Measurement[] = [];
    unit: DisplayUnit = 'stored';
    /** What was measured last, anew or again. */
    latest: Measurement | undefined;
    /** Whose points are being picked; with none yet, it is not in `items`. */
    private drawn: Measurement | undefined;
    /** The volume whose base the next click tells the height of. */
    private based: Measurement | undefined;
    private lastId = 0;
    private clicks = Promise.resolve();
    private readonly numbers = new Map<MeasureKind, number>();
    private readonly volumes: Volumes;

    constructor(
        private readonly model: Model,
        viewer: Viewer,
    ) {
        super();
        this.volumes = new Volumes(model, viewer, () => this.changed());
    }

    /** A click is for a point of the cloud. */
    get isDrawing(): boolean {
        return this.drawn !== undefined || this.based !== undefined;
    }
    isPickingBaseOf(item: Measurement): boolean {
        return this.based === item;
    }
    get drawnKind(): MeasureKind | undefined {
        return this.drawn?.kind;
    }

    /** Takes the tool in hand: the next clicks are points of a new measurement. */
    start(kind: MeasureKind): void {
        this.model.putAway();
        this.drawn = this.made(kind);
        this.changed();
    }
    /** A box with its corners. */
    addBox(points: PlacedPoint[], box: MeasuredBox): void {
        const item = { ...this.made('box'), points, box };
        this.count(item.kind);
        this.items = [...this.items, item];
        this.measure(item);
        this.changed();
    }

    /** Takes the point shown at a place of the canvas, in CSS pixels. Clicks are answered one after the other, however fast they come. */
    click(x: number, y: number): void {
        const { drawn, based } = this;
        this.inTurn(async () => {
            const point = await this.pick(x, y);
            if (point && this.drawn === drawn && this.based === based) this.take(point);
        });
    }
    private inTurn(step: () => void | Promise<void>): void {
        this.clicks = this.clicks.then(step).catch((error: unknown) => this.model.tell(error));
    }
    private take(point: PlacedPoint): void {
        if (this.based) this.setBase(this.based, { from: 'point', point });
        else this.add(point);
    }

    /** What a volume's heights are taken from. */
    setBase(item: Measurement, base: VolumeBase): void {
        if (base.from === 'height' && !Number.isFinite(base.height)) return;
        this.based = undefined;
        item.base = base;
        this.measure(item);
        this.changed();
    }
    /** The next click picks the height of the base. */
    pickBase(item: Measurement): void {
        this.finish();
        this.based = this.based === item ? undefined : item;
        this.changed();
    }

    add(point: PlacedPoint): void {
        const item = this.drawn;
        if (!item) return;
        if (samePoint(item.points.at(-1), point)) return; // the second click of a double click
        if (item.points.length === 0) {
            this.items = [...this.items, item];
            this.count(item.kind);
        }
        item.points = [...item.points, point];
        this.measure(item);
        if (item.points.length === kindOf(item.kind).points) this.drawn = undefined;
        this.changed();
    }

    /** Takes the last point back, or is done, once earlier clicks have their points. */
    takeBackInTurn(): void {
        this.inTurn(() => this.takeBack());
    }
    finishInTurn(): void {
        this.inTurn(() => this.finish());
    }

    private takeBack(): void {
        const item = this.drawn;
        if (!item) return;
        item.points = item.points.slice(0, -1);
        if (item.points.length === 0) this.items = this.items.filter((other) => other !== item);
        this.measure(item);
        this.changed();
    }

    /** Keeps what is drawn if it has points enough, and puts the tool away. */
    finish(): void {
        const item = this.drawn;
        this.based = undefined;
        if (!item) return;
        this.drawn = undefined;
        if (item.kind === 'volume') this.measure(item); // not at each of its corners
        if (item.points.length < kindOf(item.kind).least) this.items = this.items.filter((other) => other !== item);
        this.changed();
    }

    /** Puts the tool away, and what is drawn with it. */
    stop(): void {
        const item = this.drawn;
        this.drawn = undefined;
        this.based = undefined;
        this.items = this.items.filter((other) => other !== item);
        this.changed();
    }

    /** Moves a point to the one shown at a place of the canvas; nothing happens where there is none. */
    async move(item: Measurement, index: number, x: number, y: number): Promise<void> {
        const point = await this.pick(x, y);
        if (point && index < item.points.length) this.put(item, index, point);
    }
    private put(item: Measurement, index: number, point: PlacedPoint): void {
        if (!this.items.includes(item)) return;
        item.points = item.points.map((old, at) => (at === index ? point : old));
        this.measure(item);
        this.changed();
    }

    /**
     * Moves a point to the next one that shows in a direction from it (CSS pixels), looked for each `step` pixels up to `reach` away; false
     * if none is there.
     */
    async moveOn(item: Measurement, index: number, [dx, dy]: [number, number], step: number, reach: number): Promise<boolean> {
        const old = item.points[index], from = old && this.model.surface.project([old.position])[0];
        if (!from) return false;
        for (let way = step; way <= reach; way += step) {
            const point = await this.pick(from.x + way * dx, from.y + way * dy, Math.min(step - 1, 8));
            if (item.points[index] !== old) return false; // moved otherwise meanwhile
            if (!point || samePoint(old, point)) continue;
            this.put(item, index, point);
            return true;
        }
        return false;
    }

    /** Takes the place of what was measured. */
    replace(items: Pick<Measurement, 'kind' | 'name' | 'hidden' | 'points' | 'base' | 'box'>[]): void {
        this.drawn = undefined;
        this.based = undefined;
        this.items.forEach((item) => this.volumes.stop(item));
        this.items = items.map((item) => ({ id: ++this.lastId, ...item }));
        this.items.forEach((item) => this.measure(item));
        this.changed();
    }

    /** What is complete, as it is now. */
    kept(): Measurement[] {
        return this.items.flatMap((item) => (item === this.drawn ? [] : [{ ...item }]));
    }
    /** What was complete at another moment; what its answers say holds as it did. */
    restore(kept: Measurement[]): void {
        const latest = this.latest?.id;
        this.drawn = undefined;
        this.based = undefined;
        const before = this.items;
        this.items = kept.map((item) => before.find((now) => isAs(now, item)) ?? { ...item });
        for (const item of before) if (!this.items.includes(item)) this.volumes.stop(item);
        for (const item of this.items) if (!item.answer && !item.error) this.measure(item);
        this.latest = this.items.find(({ id }) => id === latest);
        this.changed();
    }

    rename(item: Measurement, name: string): void {
        item.name = name.trim() || item.name;
        this.changed();
    }
    setHidden(item: Measurement, hidden: boolean): void {
        item.hidden = hidden;
        this.changed();
    }
    remove(item: Measurement): void {
        this.items = this.items.filter((other) => other !== item);
        if (this.drawn === item) this.drawn = undefined;
        if (this.based === item) this.based = undefined;
        if (this.latest === item) this.latest = undefined;
        this.volumes.stop(item);
        this.changed();
    }
    setUnit(unit: DisplayUnit): void {
        this.unit = unit;
        this.changed();
    }

    private made(kind: MeasureKind): Measurement {
        const { texts } = this.model, number = String((this.numbers.get(kind) ?? 0) + 1);
        const name = texts.text('measure.numbered', { kind: texts.text(`measure.${kind}`), number });
        return { id: ++this.lastId, kind, name, hidden: false, points: [] };
    }
    private count(kind: MeasureKind): void {
        this.numbers.set(kind, (this.numbers.get(kind) ?? 0) + 1);
    }

    private async pick(x: number, y: number, radius?: number): Promise<PlacedPoint | null> {
        try {
            return await this.model.picking.pick(x, y, radius);
        } catch (error) {
            this.model.tell(error);
            return null;
        }
    }

    private measure(item: Measurement): void {
        this.latest = item;
        delete item.answer;
        delete item.error;
        this.volumes.stop(item);
        if (item.points.length < kindOf(item.kind).least) return;
        const obstacle = obstacleOf(item, this.model.texts);
        try {
            if (obstacle) item.error = obstacle;
            else if (item.kind === 'volume' || item.kind === 'box') {
                if (this.drawn !== item) void this.volumes.measure(item);
            }
            else item.answer = this.model.measure(requestOf(item));
        } catch (error) {
            item.error = this.model.texts.sentenceOf(error);
        }
    }

    private changed(): void {
        this.dispatchEvent(new Event('change'));
    }
}

function isAs(a: Measurement, b: Measurement): boolean {
    return a.id === b.id && a.name === b.name && a.hidden === b.hidden && a.points === b.points && a.base === b.base;
}

function samePoint(a: PlacedPoint | undefined, b: PlacedPoint): boolean {
    return (
        a !== undefined &&
        a.point.cloud === b.point.cloud &&
        a.point.node === b.point.node &&
        a.point.index === b.point.index
    );
}
