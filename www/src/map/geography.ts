import type { Model } from '../model.ts';
import type { CrsFacts, PlacedPoint, Vector } from '../wasm/values.ts';
import type { LonLat, Projection } from './projection.ts';

/** Where a cloud is on the earth, as far as its coordinate system is known and can be read. */
export type Whereabouts =
    | { state: 'known'; crs: CrsFacts; projection: Projection }
    /** The file names no system; or one that the page can't read. */
    | { state: 'unnamed' | 'unread'; crs: CrsFacts };

/** Longitudes and latitudes of places in clouds. What projects is loaded when it is wanted first. */
export class Geography {
    private load: Promise<typeof import('./projection.ts')> | undefined;
    private readonly known = new Map<string, Projection | undefined>(); // by PROJ string and WKT

    constructor(private readonly model: Model) {}

    async whereabouts(crs: CrsFacts): Promise<Whereabouts> {
        if (crs.wkt === '' && crs.proj === '' && crs.epsg === null) return { state: 'unnamed', crs };
        const key = `${crs.proj}\n${crs.wkt}`;
        if (!this.known.has(key)) {
            const { projectionOf } = await (this.load ??= import('./projection.ts'));
            this.known.set(key, projectionOf(crs));
        }
        const projection = this.known.get(key);
        return projection ? { state: 'known', crs, projection } : { state: 'unread', crs };
    }

    /** Of a point of a cloud that is open, or of one with the same system. */
    async ofPoint(point: PlacedPoint): Promise<Whereabouts | undefined> {
        const { looks } = this.model;
        const facts = looks.factsOf(point.point.cloud) ?? looks.facts().find(({ crs }) => crs.name === point.crs);
        return facts && this.whereabouts(facts.crs);
    }

    /** Null where it is not known. */
    async lonLat(point: PlacedPoint): Promise<LonLat | null> {
        const where = await this.ofPoint(point);
        if (where?.state !== 'known') return null;
        return lonLatOf(where.projection, point.position);
    }
}

/** Null for a place that has none: a projection's coordinates that are off the earth. */
export function lonLatOf(projection: Projection, place: Vector): LonLat | null {
    const [longitude, latitude] = projection.toLonLat(place);
    const isOnEarth = Math.abs(longitude) <= 180 && Math.abs(latitude) <= 90;
    return isOnEarth ? [longitude, latitude] : null;
}
