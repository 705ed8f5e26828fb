import type { Model } from '../model.ts';
import type { ClipRegion, RegionOf, ScreenPolygon, Vector } from '../wasm/values.ts';
import { inPlane, type Place } from './handles.ts';
import { atHeight, heightsShown } from './regions.ts';

type Corner = [number, number] | Vector;

/** The corners of a clip region as they are edited: those of a footprint and a corridor in plan, those of a polygon on the screen in the view that it was drawn in. */
export class Corners {
    constructor(
        private readonly model: Model,
        private readonly index: number,
    ) {}

    private get clip(): ClipRegion | undefined {
        return this.model.clipping.regions[this.index];
    }
    private get list(): Corner[] {
        const { clip } = this;
        return clip ? cornersOf(clip.region) : [];
    }
    get isClosed(): boolean {
        return this.clip !== undefined && !('line' in this.clip.region);
    }
    /** Fewer make nothing. */
    private get least(): number {
        return this.isClosed ? 3 : 2;
    }
    get canRemove(): boolean {
        return this.list.length > this.least;
    }

    /** Where they show; null where they don't. None of a polygon on the screen in another view. */
    shown(): (Place | null)[] {
        const { clip } = this;
        if (!clip || ('prism' in clip.region && !isViewOf(clip.region.prism, this.model))) return [];
        return this.project(this.list);
    }

    /** A corner goes by a step on the screen, if that makes a region. */
    move(corner: number, step: Place): boolean {
        const moved = this.list[corner] && this.moved(this.list[corner], step);
        return moved !== undefined && this.set(this.list.map((old, at) => (at === corner ? moved : old)));
    }
    /** In the middle of the edge behind a corner. */
    insert(corner: number): boolean {
        const { list } = this, a = list[corner], b = list[(corner + 1) % list.length];
        if (!a || !b) return false;
        const middle = a.map((value, axis) => (value + b[axis]!) / 2) as Corner;
        return this.set([...list.slice(0, corner + 1), middle, ...list.slice(corner + 1)]);
    }
    remove(corner: number): boolean {
        return this.canRemove && this.set(this.list.filter((_, at) => at !== corner));
    }

    private project(corners: Corner[]): (Place | null)[] {
        if (corners.length === 0) return [];
        const [low] = heightsShown(this.clip!.region, this.model.clouds);
        return this.model.surface.project(corners.map((corner) => (corner.length === 3 ? corner : atHeight([corner], low)[0]!)));
    }

    private moved(from: Corner, step: Place): Corner | undefined {
        const [at] = this.project([from]);
        if (!at) return undefined;
        if (from.length === 3) return this.model.surface.screenPolygon([{ x: at.x + step.x, y: at.y + step.y }]).corners[0];
        const unit = 0.02 * extent(this.list), [x, y] = from;
        const [right, up] = this.project([[x + unit, y], [x, y + unit]]);
        if (!right || !up) return undefined;
        const pixels = (to: Place): Place => ({ x: (to.x - at.x) / unit, y: (to.y - at.y) / unit });
        const way = inPlane(step, pixels(right), pixels(up)); // seen from the side of its plane it stays
        return way && [x + way[0], y + way[1]];
    }

    /** Edges that cross, and what else makes no region, are not taken. */
    private set(corners: Corner[]): boolean {
        const { clip } = this;
        return clip !== undefined && this.model.clipping.takesRegion(this.index, { ...clip, region: withCorners(clip.region, corners) });
    }
}

export function cornersOf(region: RegionOf): Corner[] {
    if ('prism' in region) return region.prism.corners;
    return 'polygon' in region ? region.polygon : 'line' in region ? region.line : [];
}

function withCorners(region: RegionOf, corners: Corner[]): RegionOf {
    if ('prism' in region) return { ...region, prism: { ...region.prism, corners: corners as Vector[] } };
    const places = corners as [number, number][];
    return 'polygon' in region ? { ...region, polygon: places } : { ...region, line: places };
}

function extent(corners: Corner[]): number {
    const side = (axis: 0 | 1): number => Math.max(...corners.map((at) => at[axis])) - Math.min(...corners.map((at) => at[axis]));
    return side(0) + side(1) || 1;
}

/** So near to each other (parts of the distance that is looked at) are the same eye, and the same direction. */
const sameView = 1e-9;

/** Does the camera see it as it was drawn: from its eye, or in parallel along its direction? */
export function isViewOf({ eye, forward }: ScreenPolygon, model: Model): boolean {
    const { projection, position, target } = model.camera.read(), way = minus(target, position), distance = Math.hypot(...way);
    if (eye) return projection === 'perspective' && Math.hypot(...minus(eye, position)) <= sameView * distance;
    return projection === 'orthographic' && Math.hypot(...minus(way, scaled(forward, distance))) <= sameView * distance;
}

/** Flies to where it was drawn. */
export function flyToViewOf({ eye, forward, corners }: ScreenPolygon, model: Model): void {
    const camera = model.camera.read(), distance = Math.hypot(...minus(camera.target, camera.position));
    const middle = corners[0]!.map((_, axis) => corners.reduce((sum, corner) => sum + corner[axis]!, 0) / corners.length);
    const reach = 2 * Math.max(...corners.map((corner) => Math.hypot(...minus(corner, middle))));
    const ahead = scaled(forward, distance), position = eye ?? minus(middle, ahead);
    void model.camera.flyToCamera({
        ...camera,
        projection: eye ? 'perspective' : 'orthographic',
        position,
        target: position.map((value, axis) => value + ahead[axis]!),
        ...(!eye && { orthoHeight: Math.max(camera.orthoHeight, 1.2 * reach) }),
    });
}

/** In its direction, so long. */
function scaled(direction: Vector, length: number): number[] {
    return direction.map((value) => (value * length) / Math.hypot(...direction));
}
function minus(a: readonly number[], b: readonly number[]): number[] {
    return a.map((value, axis) => value - b[axis]!);
}
