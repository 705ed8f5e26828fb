import type { LonLat } from './projection.ts';

/** Places are longitude and latitude on the earth, else x and y of the clouds. */
export interface MapShape {
    kind: 'footprint' | 'camera' | 'cone' | 'measurement';
    geometry: 'point' | 'line' | 'polygon';
    places: LonLat[];
    name?: string;
}

/** Of the base layer: an XYZ template, and who made it. */
export interface BaseLayer {
    template: string;
    attribution: string;
}

/** On the earth (longitudes and latitudes, base layer, graticule), or on the plane of a cloud's own coordinates. */
export type MapFrame = { kind: 'earth' } | { kind: 'plane'; unitMeters: number };
