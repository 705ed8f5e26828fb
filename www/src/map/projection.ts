import proj4 from 'proj4';

import type { CrsFacts, Vector } from '../wasm/values.ts';

/** Longitude and latitude in degrees on WGS 84. */
export type LonLat = [number, number];

/** Between a cloud's coordinates and longitude and latitude. */
export interface Projection {
    toLonLat(place: Vector): LonLat;
    /** At the height (or, geocentric, the height above the ellipsoid) of `like`. */
    fromLonLat(at: LonLat, like: Vector): Vector;
}

/**
 * By what proj4 reads of the system: its PROJ string, else its WKT. Undefined where it reads neither, and where it does not
 * know how the datum lies to WGS 84: longitudes that are off by a hundred metres and more would be worse than none.
 */
export function projectionOf(crs: CrsFacts): Projection | undefined {
    for (const definition of [crs.proj, crs.wkt].filter((text) => text !== '')) {
        const projection = projectionBy(definition);
        if (projection) return projection;
    }
    return undefined;
}

function projectionBy(definition: string): Projection | undefined {
    try {
        const text = horizontalPart(definition);
        if (!hasKnownDatum(new proj4.Proj(text) as unknown as ReadSystem)) return undefined;
        const system = proj4(text, 'WGS84');
        system.forward([0, 0, 0]); // some definitions show what is wrong with them only here
        return {
            toLonLat: ([x, y, z]) => {
                const [longitude, latitude] = system.forward([x, y, z]) as Vector;
                return [longitude, latitude];
            },
            fromLonLat: (at, like) => {
                const height = (system.forward([...like]) as Vector)[2] ?? like[2];
                const [x, y, z] = system.inverse([at[0], at[1], height]) as Vector;
                return [x, y, z ?? like[2]];
            },
        };
    } catch {
        return undefined; // something else may be read
    }
}

/** What proj4 makes of a definition. */
interface ReadSystem {
    a: number;
    datum?: { datum_type: number };
}
const enum DatumType {
    threeParameters = 1,
    sevenParameters = 2,
    wgs84 = 4,
    none = 5,
}

/** Systems on the ellipsoid of GRS 80 without a shift (ETRS89, NAD83, RGF93, …) are WGS 84 to a metre or two. */
function hasKnownDatum({ a, datum }: ReadSystem): boolean {
    const type = datum?.datum_type;
    if (type === DatumType.none || type === undefined) return a === 6378137;
    return type === DatumType.threeParameters || type === DatumType.sevenParameters || type === DatumType.wgs84;
}

/** Of a compound PROJ string the part that says where east and north are: heights stay as the cloud has them. */
function horizontalPart(definition: string): string {
    if (!definition.startsWith('+')) return definition;
    return definition
        .split(/\s+(?=\+)/)
        .filter((part) => !/^\+(vunits|vto_meter|geoidgrids|geoid_crs|type|nadgrids=@null)/.test(part))
        .join(' ');
}

