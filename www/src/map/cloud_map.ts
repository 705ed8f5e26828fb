import Collection from 'ol/Collection.js';
import Feature from 'ol/Feature.js';
import OlMap from 'ol/Map.js';
import View from 'ol/View.js';
import ScaleLine from 'ol/control/ScaleLine.js';
import Zoom from 'ol/control/Zoom.js';
import type { Coordinate } from 'ol/coordinate.js';
import LineString from 'ol/geom/LineString.js';
import Point from 'ol/geom/Point.js';
import Polygon from 'ol/geom/Polygon.js';
import Graticule from 'ol/layer/Graticule.js';
import TileLayer from 'ol/layer/Tile.js';
import VectorLayer from 'ol/layer/Vector.js';
import { fromLonLat, Projection as MapProjection, toLonLat } from 'ol/proj.js';
import ImageTile from 'ol/source/ImageTile.js';
import VectorSource from 'ol/source/Vector.js';
import Circle from 'ol/style/Circle.js';
import Fill from 'ol/style/Fill.js';
import Stroke from 'ol/style/Stroke.js';
import Style from 'ol/style/Style.js';
import Text from 'ol/style/Text.js';
import css from 'ol/ol.css?inline';

import { ticks } from '../looks/ranges.ts';
import type { LonLat } from './projection.ts';
import type { BaseLayer, MapFrame, MapShape } from './shapes.ts';

export { css as mapStyles };

const accent = '#6cc5b4', ink = '#e8eaed', line = 'rgba(163, 171, 184, 0.45)';

/** The map itself, by OpenLayers: shapes over a base layer, or over lines of its coordinates alone. */
export class CloudMap {
    private readonly map: OlMap;
    private readonly shapes = new VectorSource();
    private readonly grid = new VectorSource();
    private readonly isEarth: boolean;
    private shown: MapShape[] = [];

    /** `went`: a person clicked there. `failed`: a tile of the base layer could not be had. */
    constructor(
        target: HTMLElement,
        frame: MapFrame,
        base: BaseLayer | undefined,
        went: (at: LonLat) => void,
        failed: (reason: string) => void,
    ) {
        this.isEarth = frame.kind === 'earth';
        const layers = new Collection<TileLayer | VectorLayer | Graticule>();
        if (this.isEarth && base) layers.push(baseLayer(base, failed));
        if (this.isEarth) layers.push(graticule());
        else layers.push(new VectorLayer({ source: this.grid, style: gridStyle }));
        layers.push(new VectorLayer({ source: this.shapes, style: styleOf }));
        this.map = new OlMap({
            target,
            layers,
            controls: scaleControls(frame),
            view: new View({
                center: [0, 0],
                zoom: 1,
                ...(frame.kind === 'plane' ? { projection: planeOf(frame.unitMeters), maxZoom: 60, minZoom: -20 } : { maxZoom: 24 }),
            }),
        });
        this.map.on('click', (event) => went(this.fromMap(event.coordinate)));
        this.map.on('moveend', () => this.drawGrid());
    }

    dispose(): void {
        this.map.setTarget(undefined);
        this.map.dispose();
    }

    show(shapes: MapShape[]): void {
        if (JSON.stringify(shapes) === JSON.stringify(this.shown)) return;
        this.shown = shapes;
        this.shapes.clear();
        this.shapes.addFeatures(
            shapes.map((shape) => {
                const places = shape.places.map((place) => this.toMap(place));
                const geometry =
                    shape.geometry === 'point'
                        ? new Point(places[0]!)
                        : shape.geometry === 'line'
                          ? new LineString(places)
                          : new Polygon([[...places, places[0]!]]);
                return new Feature({ geometry, kind: shape.kind, name: shape.name });
            }),
        );
    }

    /** All that is shown of one kind. */
    fit(kind: MapShape['kind']): void {
        const places = this.shown.filter((shape) => shape.kind === kind).flatMap((shape) => shape.places.map((place) => this.toMap(place)));
        if (places.length === 0) return;
        const axis = (i: 0 | 1): number[] => places.map((place) => place[i]!);
        const extent = [Math.min(...axis(0)), Math.min(...axis(1)), Math.max(...axis(0)), Math.max(...axis(1))];
        this.map.getView().fit(extent, { padding: [24, 24, 24, 24] });
    }

    /** Where a place is in the map's element, in CSS pixels; null while it has no size. */
    pixelOf(place: LonLat): [number, number] | null {
        this.map.renderSync();
        return (this.map.getPixelFromCoordinate(this.toMap(place)) as [number, number] | null) ?? null;
    }

    private toMap(place: LonLat): Coordinate {
        return this.isEarth ? fromLonLat(place) : place;
    }
    private fromMap(at: Coordinate): LonLat {
        const [x, y] = this.isEarth ? toLonLat(at) : at;
        return [x!, y!];
    }

    /** Lines of round coordinates, where there is no graticule. */
    private drawGrid(): void {
        if (this.isEarth) return;
        const [left, bottom, right, top] = this.map.getView().calculateExtent(this.map.getSize()) as [number, number, number, number];
        const lineOf = (value: number, ends: Coordinate[]): Feature =>
            new Feature({ geometry: new LineString(ends), name: String(value) });
        this.grid.clear();
        this.grid.addFeatures([
            ...ticks([left, right]).map((x) => lineOf(x, [[x, bottom], [x, top]])),
            ...ticks([bottom, top]).map((y) => lineOf(y, [[left, y], [right, y]])),
        ]);
    }
}

/** Fetched as data, so that the page's security policy needs to allow no images of other hosts. */
function baseLayer({ template }: BaseLayer, failed: (reason: string) => void): TileLayer {
    const source = new ImageTile({
        loader: async (z, x, y, { signal }) => {
            const address = template
                .replaceAll('{z}', String(z))
                .replaceAll('{x}', String(x))
                .replaceAll('{y}', String(y))
                .replaceAll('{-y}', String(2 ** z - 1 - y));
            const answer = await fetch(address, { signal, credentials: 'omit', referrerPolicy: 'no-referrer' }).catch((error: unknown) => {
                if (!signal.aborted) failed(String(error));
                throw error;
            });
            if (!answer.ok) {
                failed(`${answer.status} ${answer.statusText}`);
                throw new Error(String(answer.status));
            }
            return createImageBitmap(await answer.blob());
        },
    });
    return new TileLayer({ source });
}

function graticule(): Graticule {
    const text = new Text({ font: '11px system-ui, sans-serif', fill: new Fill({ color: ink }), textBaseline: 'bottom' });
    return new Graticule({
        strokeStyle: new Stroke({ color: line, width: 1 }),
        showLabels: true,
        lonLabelStyle: text,
        latLabelStyle: new Text({ font: '11px system-ui, sans-serif', fill: new Fill({ color: ink }), textAlign: 'end' }),
        wrapX: false,
        intervals: [90, 45, 30, 20, 10, 5, 2, 1, 30 / 60, 20 / 60, 10 / 60, 5 / 60, 2 / 60, 1 / 60, 30 / 3600, 20 / 3600, 10 / 3600, 5 / 3600, 2 / 3600, 1 / 3600],
    });
}

function planeOf(unitMeters: number): MapProjection {
    return new MapProjection({
        code: 'cloud',
        units: 'm',
        metersPerUnit: unitMeters > 0 ? unitMeters : 1,
        extent: [-1e8, -1e8, 1e8, 1e8],
        getPointResolution: (resolution) => resolution,
    });
}

/** Without a known unit there is no scale bar. */
function scaleControls(frame: MapFrame): Collection<Zoom | ScaleLine> {
    const hasScale = frame.kind === 'earth' || frame.unitMeters > 0;
    return new Collection<Zoom | ScaleLine>([new Zoom(), ...(hasScale ? [new ScaleLine()] : [])]);
}

const gridStyle = (feature: { get: (name: string) => unknown }): Style =>
    new Style({
        stroke: new Stroke({ color: line, width: 1 }),
        text: new Text({ text: String(feature.get('name')), font: '11px system-ui, sans-serif', fill: new Fill({ color: ink }), placement: 'line', textBaseline: 'bottom' }),
    });

function styleOf(feature: { get: (name: string) => unknown }): Style {
    const kind = feature.get('kind') as MapShape['kind'];
    const colour = kind === 'measurement' ? '#ffd166' : kind === 'footprint' ? ink : accent;
    const stroke = new Stroke({ color: colour, width: kind === 'footprint' ? 1.5 : 2 });
    return new Style({
        stroke,
        fill: new Fill({ color: kind === 'cone' ? 'rgba(108, 197, 180, 0.3)' : 'rgba(232, 234, 237, 0.08)' }),
        image: new Circle({ radius: 5, fill: new Fill({ color: colour }), stroke: new Stroke({ color: '#1a1d22', width: 1.5 }) }),
        zIndex: kind === 'footprint' ? 0 : 1,
        ...(kind === 'footprint' && {
            text: new Text({
                text: String(feature.get('name') ?? ''),
                font: '12px system-ui, sans-serif',
                fill: new Fill({ color: ink }),
                stroke: new Stroke({ color: '#1a1d22', width: 3 }),
                overflow: true,
            }),
        }),
    });
}
