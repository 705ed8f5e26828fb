import type { PlacedPoint } from '../wasm/values.ts';

/** Files of measurements for other programs. Coordinates and lengths are in the cloud's own unit and system, but for GeoJSON's coordinates. */
export type ExportFormat = 'json' | 'csv' | 'geojson' | 'dxf';

export const exportFormats: { format: ExportFormat; label: string; type: string }[] = [
    { format: 'json', label: 'JSON', type: 'application/json' },
    { format: 'csv', label: 'CSV', type: 'text/csv' },
    { format: 'geojson', label: 'GeoJSON', type: 'application/geo+json' },
    { format: 'dxf', label: 'DXF', type: 'image/vnd.dxf' },
];

/** Longitude and latitude (WGS 84) of points. */
export type LonLats = ReadonlyMap<PlacedPoint, [number, number]>;
