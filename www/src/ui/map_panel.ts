import { css, html, type PropertyValues, type TemplateResult, unsafeCSS } from 'lit';

import type { Whereabouts } from '../map/geography.ts';
import { lonLatOf } from '../map/geography.ts';
import type { CloudMap } from '../map/cloud_map.ts';
import { boxCorners, convexHull, footprint, movedTo, viewCone } from '../map/plan.ts';
import type { LonLat } from '../map/projection.ts';
import type { BaseLayer, MapShape } from '../map/shapes.ts';
import { kindOf } from '../measuring/measurement.ts';
import { outlineOf } from '../measuring/outline.ts';
import type { CloudState, Vector } from '../wasm/values.ts';
import { ModelElement } from './model_element.ts';
import { panelHead } from './panel_head.ts';
import { controlStyles, headStyles } from './shared_styles.ts';

const baseLayerKey = 'stipple.baseLayer';

/** Where the clouds are: on the earth, as far as their coordinate system can be read, else in their own coordinates. */
export class MapPanel extends ModelElement {
    static override properties = {
        ...ModelElement.properties,
        base: { state: true },
        note: { state: true },
        failure: { state: true },
        isEditing: { state: true },
    };
    declare base: BaseLayer | undefined;
    /** Why the map is not on the earth. */
    declare note: string;
    declare failure: string;
    declare isEditing: boolean;

    static override styles = [
        controlStyles,
        headStyles,
        css`
            .map {
                position: relative;
                height: 240px;
                margin-top: 0.5rem;
                border-radius: 8px;
                overflow: hidden;
                background: #14161a;
                outline-offset: -2px;
            }
            .note {
                margin: 0.4rem 0 0;
                font-size: 0.8rem;
                color: var(--muted);
                overflow-wrap: anywhere;
            }
            form {
                display: grid;
                gap: 0.3rem;
                margin-top: 0.5rem;
            }
        `,
    ];

    private map: CloudMap | undefined;
    private frame = ''; // what the map was made for
    private where: Whereabouts | undefined; // of the first cloud, whose coordinates are the world's
    private footprints: MapShape[] = [];
    private fitted = '';
    private isDue = false;

    constructor() {
        super();
        this.note = '';
        this.failure = '';
        this.isEditing = false;
    }

    override connectedCallback(): void {
        super.connectedCallback();
        this.base = this.model.baseLayer ?? storedBaseLayer();
        this.model.addEventListener('frame', this.renewSoon);
    }
    override disconnectedCallback(): void {
        this.model.removeEventListener('frame', this.renewSoon);
        this.map?.dispose();
        this.map = undefined;
        this.frame = '';
        super.disconnectedCallback();
    }
    protected override sources(): EventTarget[] {
        return [this.model.measuring];
    }
    override updated(changed: PropertyValues): void {
        super.updated(changed);
        this.renewSoon();
    }

    override render(): TemplateResult {
        const base = html`<button aria-expanded=${this.isEditing} @click=${() => (this.isEditing = !this.isEditing)}>
            ${this.text('map.base')}
        </button>`;
        return html`${panelHead(this.text('map'), this.text('map.close'), () => this.model.showMap(false), base)}
            ${this.isEditing ? this.renderBase() : ''}
            <div class="map" tabindex="0" role="application" aria-label=${this.text('map.label')}></div>
            ${this.base?.attribution ? html`<p class="note">${this.base.attribution}</p>` : ''}
            ${this.note ? html`<p class="note">${this.note}</p>` : ''}
            ${this.failure ? html`<p class="note" role="status">${this.text('map.baseFailed', { reason: this.failure })}</p>` : ''}`;
    }

    private renderBase(): TemplateResult {
        return html`<form @submit=${this.keepBase}>
            <input name="template" aria-label=${this.text('map.template')} placeholder="https://…/{z}/{x}/{y}.png" .value=${this.base?.template ?? ''} />
            <input name="attribution" aria-label=${this.text('map.attribution')} placeholder=${this.text('map.attribution')} .value=${this.base?.attribution ?? ''} />
            <button>${this.text('map.use')}</button>
        </form>`;
    }

    private keepBase(event: Event): void {
        event.preventDefault();
        const fields = new FormData(event.target as HTMLFormElement);
        const template = String(fields.get('template')).trim(), attribution = String(fields.get('attribution')).trim();
        this.base = template === '' ? undefined : { template, attribution };
        this.failure = '';
        this.isEditing = false;
        try {
            if (this.base) localStorage.setItem(baseLayerKey, JSON.stringify(this.base));
            else localStorage.removeItem(baseLayerKey);
        } catch {
            // A browser that keeps nothing: it holds for now.
        }
    }

    // The map follows at most once a frame.

    private readonly renewSoon = (): void => {
        if (this.isDue) return;
        this.isDue = true;
        requestAnimationFrame(() => {
            this.isDue = false;
            void this.renew();
        });
    };

    private async renew(): Promise<void> {
        const { model } = this, clouds = model.clouds.filter(({ bounds, visible }) => visible && bounds);
        const places = await Promise.all(clouds.map(async (cloud) => ({ cloud, where: await this.whereaboutsOf(cloud) })));
        if (!this.isConnected || places.length === 0) return;
        this.where = places[0]!.where;
        const isEarth = this.where?.state === 'known';
        this.note = places.flatMap(({ cloud, where }) => this.noteOf(cloud, where, isEarth)).join(' ');
        this.footprints = places.flatMap(({ cloud, where }) => this.footprintOf(cloud, where, isEarth));
        await this.makeMap(isEarth);
        if (!this.map) return;
        this.map.show([...this.footprints, ...this.cameraShapes(), ...this.measurementShapes()]);
        const shown = JSON.stringify(this.footprints);
        if (shown !== this.fitted) this.map.fit('footprint');
        this.fitted = shown;
    }

    private async whereaboutsOf({ id }: CloudState): Promise<Whereabouts | undefined> {
        const facts = this.model.looks.factsOf(id);
        return facts && this.model.geography.whereabouts(facts.crs);
    }

    private noteOf({ name }: CloudState, where: Whereabouts | undefined, isEarth: boolean): string[] {
        if (!where || where.state === 'known') return isEarth || !where ? [] : [this.text('map.otherSystem', { name })];
        if (where.state === 'unnamed') return [this.text('map.unnamed', { name })];
        return [this.text('map.unread', { name, system: where.crs.name || 'WKT' })];
    }

    private async makeMap(isEarth: boolean): Promise<void> {
        const unitMeters = this.where?.crs.unitMeters ?? 0;
        const frame = JSON.stringify([isEarth, isEarth ? this.base : unitMeters]);
        if (frame === this.frame) return;
        this.frame = frame;
        const { CloudMap, mapStyles } = await import('../map/cloud_map.ts');
        const root = this.renderRoot as ShadowRoot, target = root.querySelector<HTMLElement>('.map');
        if (!target || frame !== this.frame) return;
        const sheet = unsafeCSS(mapStyles).styleSheet!;
        if (!this.map) root.adoptedStyleSheets = [...root.adoptedStyleSheets, sheet];
        this.map?.dispose();
        this.fitted = '';
        this.map = new CloudMap(
            target,
            isEarth ? { kind: 'earth' } : { kind: 'plane', unitMeters },
            this.base,
            (at) => this.goTo(at),
            (reason) => (this.failure = reason),
        );
    }

    // What it shows

    private placeOf(place: Vector, where: Whereabouts | undefined, isEarth: boolean): LonLat | null {
        if (!isEarth) return [place[0], place[1]];
        return where?.state === 'known' ? lonLatOf(where.projection, place) : null;
    }

    private footprintOf({ bounds, name }: CloudState, where: Whereabouts | undefined, isEarth: boolean): MapShape[] {
        if (isEarth !== (where?.state === 'known')) return [];
        const isBox = isEarth && where!.crs.geocentric;
        const places = (isBox ? boxCorners(bounds!) : footprint(bounds!)).flatMap((place) => {
            const at = this.placeOf(place, where, isEarth);
            return at ? [at] : [];
        });
        if (places.length < 3) return [];
        return [{ kind: 'footprint', geometry: 'polygon', places: isBox ? convexHull(places) : places, name }];
    }

    private inWorld(places: Vector[]): LonLat[] {
        const isEarth = this.where?.state === 'known';
        return places.flatMap((place) => this.placeOf(place, this.where, isEarth) ?? []).length === 2 * places.length
            ? places.map((place) => this.placeOf(place, this.where, isEarth)!)
            : [];
    }

    private cameraShapes(): MapShape[] {
        const { canvas, camera } = this.model, now = camera.read();
        const cone = this.inWorld(viewCone(now, canvas.width / canvas.height, this.where?.crs.geocentric ?? false));
        const at = this.inWorld([now.position]);
        this.toggleAttribute('data-has-camera', at.length > 0);
        this.dataset['camera'] = JSON.stringify(at[0] ?? null);
        return [
            ...(cone.length > 0 ? [{ kind: 'cone', geometry: 'polygon', places: cone } as const] : []),
            ...(at.length > 0 ? [{ kind: 'camera', geometry: 'point', places: at } as const] : []),
        ];
    }

    private measurementShapes(): MapShape[] {
        return this.model.measuring.items
            .filter(({ hidden, points }) => !hidden && points.length > 0)
            .flatMap((item): MapShape[] => {
                const places = this.inWorld(outlineOf(item).map(({ position }) => position));
                const isPolygon = (kindOf(item.kind).isClosed || item.box) && places.length > 2;
                const geometry = places.length === 1 ? 'point' : isPolygon ? 'polygon' : 'line';
                return places.length > 0 ? [{ kind: 'measurement', geometry, places, name: item.name }] : [];
            });
    }

    /** The camera looks at the clicked place as it looked at the one before. */
    private goTo(at: LonLat): void {
        const camera = this.model.camera.read();
        const isKnown = this.where?.state === 'known';
        const target: Vector =
            this.where?.state === 'known' ? this.where.projection.fromLonLat(at, camera.target) : [at[0], at[1], camera.target[2]];
        if (!target.every(Number.isFinite)) return;
        void this.model.camera.flyToCamera(movedTo(camera, target, isKnown && this.where!.crs.geocentric));
    }

    /** For tests: where a place is on the screen. */
    screenOf(place: LonLat): { x: number; y: number } | null {
        const pixel = this.map?.pixelOf(place), box = this.renderRoot.querySelector('.map')?.getBoundingClientRect();
        return pixel && box ? { x: box.left + pixel[0], y: box.top + pixel[1] } : null;
    }
    shapes(): MapShape[] {
        return [...this.footprints, ...this.cameraShapes(), ...this.measurementShapes()];
    }
}

/** What was kept in this browser. */
function storedBaseLayer(): BaseLayer | undefined {
    try {
        const stored: unknown = JSON.parse(localStorage.getItem(baseLayerKey) ?? 'null');
        const { template, attribution } = (stored ?? {}) as Partial<BaseLayer>;
        return typeof template === 'string' && typeof attribution === 'string' ? { template, attribution } : undefined;
    } catch {
        return undefined;
    }
}

customElements.define('stipple-map', MapPanel);
