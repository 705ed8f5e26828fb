import { edges } from '../clipping/boxes.ts';
import type { Vector } from '../wasm/values.ts';
import type { ExportFormat, LonLats } from './export_formats.ts';
import { kindOf, type Measurement, type VolumeBase } from './measurement.ts';
import { outlineOf } from './outline.ts';

/** `lonLats` of every point: what GeoJSON is in where they are known. */
export function exportText(items: Measurement[], format: ExportFormat, lonLats?: LonLats): string {
    const writers: Record<ExportFormat, (items: Measurement[]) => string> = {
        json: asJson,
        csv: asCsv,
        geojson: (all) => asGeoJson(all, lonLats),
        dxf: asDxf,
    };
    return writers[format](items);
}

function positions(item: Measurement): Vector[] {
    return item.points.map((point) => point.position);
}

function asJson(items: Measurement[]): string {
    const measurements = items.map((item) => ({
        name: item.name,
        kind: item.kind,
        crs: item.points[0]!.crs,
        unit: item.points[0]!.unit,
        points: item.points.map(({ position, integers, cloudName, point }) => ({
            position,
            integers,
            cloud: cloudName,
            node: point.node,
            index: point.index,
        })),
        ...(item.base && { base: baseOf(item.base) }),
        ...(item.box && { box: item.box }),
        ...(item.answer && { result: item.answer }),
        ...(item.error && { error: item.error }),
    }));
    return `${JSON.stringify({ version: 1, measurements }, null, 2)}\n`;
}

function baseOf(base: VolumeBase): object {
    return base.from === 'point' ? { from: 'point', position: base.point.position } : base;
}

/** RFC 4180: one row a measurement, a column a value that any of them has. */
function asCsv(items: Measurement[]): string {
    const names = [...new Set(items.flatMap((item) => Object.keys(numbersOf(item))))];
    const rows = items.map((item) => {
        const numbers = numbersOf(item);
        const { crs, unit } = item.points[0]!;
        const places = positions(item).map((place) => place.join(' ')).join('; ');
        return [item.name, item.kind, crs, unit, ...names.map((name) => numbers[name] ?? ''), places];
    });
    return [['name', 'kind', 'crs', 'unit', ...names, 'points'], ...rows]
        .map((row) => `${row.map(csvField).join(',')}\r\n`)
        .join('');
}

function numbersOf({ answer }: Measurement): Record<string, number> {
    return Object.fromEntries(
        Object.entries(answer ?? {}).filter((entry): entry is [string, number] => typeof entry[1] === 'number'),
    );
}

function csvField(value: string | number): string {
    const text = String(value);
    // A text that a spreadsheet would take for a formula is made one that it does not.
    const safe = typeof value === 'string' && /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
    return /[",\r\n;]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

/**
 * RFC 7946: longitude and latitude, with the cloud's own exact coordinates among the properties. Where these are not known,
 * the cloud's coordinates with the `crs` member of GeoJSON 2008, which programs that read projected coordinates look at.
 */
function asGeoJson(items: Measurement[], lonLats?: LonLats): string {
    const { epsg } = items[0]?.points[0] ?? { epsg: null };
    const features = items.map((item) => ({
        type: 'Feature',
        properties: {
            name: item.name,
            kind: item.kind,
            unit: item.points[0]!.unit,
            ...numbersOf(item),
            ...(lonLats && { crs: item.points[0]!.crs, epsg: item.points[0]!.epsg, coordinates: positions(item) }),
        },
        geometry: geometryOf(item, outlineOf(item).map((point) => lonLats?.get(point) ?? point.position)),
    }));
    return `${JSON.stringify({
        type: 'FeatureCollection',
        ...(epsg && !lonLats && { crs: { type: 'name', properties: { name: `urn:ogc:def:crs:EPSG::${epsg}` } } }),
        features,
    })}\n`;
}

function geometryOf(item: Measurement, places: number[][]): object {
    if (places.length === 1) return { type: 'Point', coordinates: places[0] };
    if ((kindOf(item.kind).isClosed || item.box) && places.length > 2)
        return { type: 'Polygon', coordinates: [counterClockwise([...places, places[0]!])] };
    return { type: 'LineString', coordinates: places };
}

/** RFC 7946 §3.1.6: outer rings run counter-clockwise. */
function counterClockwise(ring: number[][]): number[][] {
    const [x0, y0] = ring[0]! as [number, number];
    const twice = ring
        .slice(1)
        .reduce((sum, [x, y], i) => sum + (ring[i]![0]! - x0) * (y! - y0) - (x! - x0) * (ring[i]![1]! - y0), 0);
    return twice < 0 ? [...ring].reverse() : ring;
}

/** DXF R12 (AC1009), which every CAD program reads: a layer a kind, points, polylines in space, names as texts. */
function asDxf(items: Measurement[]): string {
    const group = (code: number, value: string | number): string => `${code}\r\n${value}\r\n`;
    const place = ([x, y, z]: Vector): string => group(10, x) + group(20, y) + group(30, z);
    const entities = items.map((item) => {
        const layer = group(8, item.kind.toUpperCase());
        const places = positions(item);
        const text = group(0, 'TEXT') + layer + place(places[0]!) + group(40, 1) + group(1, dxfText(item.name));
        if (places.length === 1) return group(0, 'POINT') + layer + place(places[0]!) + text;
        if (item.box) {
            const end = ([x, y, z]: Vector): string => group(11, x) + group(21, y) + group(31, z);
            return edges.map(([a, b]) => group(0, 'LINE') + layer + place(places[a]!) + end(places[b]!)).join('') + text;
        }
        const closed = kindOf(item.kind).isClosed ? 1 : 0;
        const vertices = places.map((at) => group(0, 'VERTEX') + layer + place(at) + group(70, 32));
        return (
            group(0, 'POLYLINE') + layer + group(66, 1) + place([0, 0, 0]) + group(70, 8 + closed) +
            vertices.join('') + group(0, 'SEQEND') + layer + text
        );
    });
    const section = (name: string, content: string): string =>
        group(0, 'SECTION') + group(2, name) + content + group(0, 'ENDSEC');
    return (
        section('HEADER', group(9, '$ACADVER') + group(1, 'AC1009')) +
        section('ENTITIES', entities.join('')) +
        group(0, 'EOF')
    );
}

/** R12 is ASCII: other characters as \U+XXXX, which later programs show. */
function dxfText(text: string): string {
    return [...text.replace(/[\r\n]+/g, ' ')]
        .map((c) => (c >= ' ' && c <= '~' ? c : `\\U+${c.codePointAt(0)!.toString(16).toUpperCase().padStart(4, '0')}`))
        .join('');
}
