import { css, html, type PropertyValues, svg, type SVGTemplateResult, type TemplateResult } from 'lit';

import { type CursorWay, neighbour } from '../profile/profile_cursor.ts';
import type { Profile } from '../profile/profile.ts';
import { coloursOf, type ProfileColour } from '../profile/profile_colours.ts';
import type { ProfilePoints } from '../profile/profile_points.ts';
import { draw, fitted, margin, nearest, panned, type ProfileView, ticks, toPixels, toProfile, zoomed } from '../profile/profile_view.ts';
import type { RegionFormat } from '../wasm/values.ts';
import { download } from './download.ts';
import { followPointer } from './follow_pointer.ts';
import { ModelElement } from './model_element.ts';
import { servedLink } from './served_link.ts';
import { controlStyles } from './shared_styles.ts';

const formats = ['laz', 'las', 'csv'];
type Corridor = 'off' | 'highlight' | 'hideOutside';
const corridors: Corridor[] = ['off', 'highlight', 'hideOutside'];
const ownFormats: RegionFormat[] = ['laz', 'las', 'csv'];

/** Pixels of one press of an arrow key; what one press of + leaves of the view's sides. */
const keyStep = 40;
const keyZoom = 0.8;
/** Points that show so near to a line upwards, in pixels, are above each other. */
const columnSlack = 4;
const ways: Record<string, CursorWay> = { ArrowLeft: 'back', ArrowRight: 'on', ArrowUp: 'up', ArrowDown: 'down' };
const steps: Record<string, [number, number]> = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/**
 * The 2D view of a profile: station to the right, height upwards; drag moves, wheel zooms, a click takes a point to measure from. By the
 * keyboard arrows move, + and - zoom, Home shows all; with shift arrows go from point to point, and Enter or the space bar take the one
 * that was come to.
 */
export class ProfilePanel extends ModelElement {
    static override properties = {
        ...ModelElement.properties,
        hovered: { state: true },
        marked: { state: true },
        said: { state: true },
        colour: { state: true },
    };
    /** Index of the point under the pointer, and of the one that was clicked; -1: none. */
    declare hovered: number;
    declare marked: number;
    /** Of the point that the keys came to, for those who do not see it. */
    declare said: string;
    /** None was chosen: the first that the clouds have. */
    declare colour: ProfileColour | undefined;

    static override styles = [
        controlStyles,
        css`
            .bar {
                display: flex;
                flex-wrap: wrap;
                align-items: center;
                gap: 0.3rem 0.9rem;
                font-size: 0.82rem;
            }
            .bar h2 {
                margin: 0;
            }
            .bar label {
                display: flex;
                align-items: center;
                gap: 0.4rem;
            }
            .bar input {
                width: 4.5rem;
            }
            .bar a {
                color: var(--accent);
            }
            .bar button {
                min-height: 1.75rem;
            }
            .state {
                unicode-bidi: plaintext;
                color: var(--muted);
            }
            .close {
                margin-inline-start: auto;
            }
            .view {
                position: relative;
                height: 200px;
                margin-top: 0.4rem;
                touch-action: none;
                cursor: crosshair;
            }
            canvas,
            svg {
                position: absolute;
                inset: 0;
                width: 100%;
                height: 100%;
            }
            text {
                font: 11px system-ui, sans-serif;
                fill: var(--muted);
            }
            .grid {
                stroke: var(--line);
                stroke-width: 1;
            }
            .mark {
                fill: none;
                stroke: var(--accent);
                stroke-width: 2;
            }
            .told {
                margin: 0.3rem 0 0;
                min-height: 1.3em;
                font-size: 0.82rem;
                font-variant-numeric: tabular-nums;
                user-select: text;
            }
            .error {
                color: var(--danger);
            }
        `,
    ];

    private shown: ProfileView | undefined;
    /** Somebody has chosen what is in view; until then it is all that is here. */
    private isMoved = false;
    private cut: unknown;
    private readonly letGo = (): void => {
        this.hovered = this.marked = -1;
        this.said = '';
    };
    private coloured: { points: ProfilePoints; key: string; words: Uint32Array } | undefined;

    constructor() {
        super();
        this.hovered = this.marked = -1;
        this.said = '';
    }
    override connectedCallback(): void {
        super.connectedCallback();
        this.profile.addEventListener('change', this.letGo);
    }
    override disconnectedCallback(): void {
        this.profile.removeEventListener('change', this.letGo);
        super.disconnectedCallback();
    }
    protected override sources(): EventTarget[] {
        return [this.profile, this.model.regionFiles];
    }

    private get profile(): Profile {
        return this.model.profile;
    }
    private get area(): HTMLElement | null {
        return this.renderRoot.querySelector<HTMLElement>('.view');
    }

    override render(): TemplateResult {
        const { profile } = this, { points } = profile;
        const state = this.text(
            profile.isLoading ? 'profile.loading' : profile.isComplete ? 'profile.complete' : 'profile.thinned',
        );
        return html`<div class="bar">
                <h2>${this.text('profile')}</h2>
                <label>
                    ${this.text('profile.width')}
                    <input
                        type="number"
                        step="any"
                        min="0"
                        aria-label=${this.text('profile.widthLabel')}
                        .value=${String(profile.width)}
                        @change=${(event: Event) => profile.setWidth((event.target as HTMLInputElement).valueAsNumber)}
                    />
                </label>
                <label>
                    ${this.text('profile.exaggeration')}
                    <input
                        type="number"
                        step="0.5"
                        min="0.1"
                        max="100"
                        aria-label=${this.text('profile.exaggerationLabel')}
                        .value=${String(profile.exaggeration)}
                        @change=${(event: Event) => this.exaggerate((event.target as HTMLInputElement).valueAsNumber)}
                    />
                </label>
                ${this.renderChoice(this.text('profile.colour'), this.colour ?? this.colourModes()[0]!, this.colourModes().map((mode) => [mode, this.text(`colour.${mode}`)]), (mode) => (this.colour = mode))}
                ${this.renderChoice<Corridor>(
                    this.text('profile.inPicture'),
                    (profile.corridor?.mode as Corridor | undefined) ?? 'off',
                    corridors.map((mode) => [mode, this.text(mode === 'off' ? 'profile.corridorOff' : mode === 'highlight' ? 'clip.highlight' : 'profile.isolate')]),
                    (mode) => profile.showCorridor(mode === 'off' ? undefined : mode),
                )}
                <button @click=${() => this.fit()}>${this.text('profile.fit')}</button>
                <span class="state" role="status" data-points=${points.count}>
                    ${this.text('profile.state', { count: points.count, state })}
                </span>
                ${formats.flatMap((format) =>
                    profile
                        .addresses(format)
                        .map(({ name, href }) =>
                            servedLink(this.model, href, format, `${name}-profile`, this.text('profile.allPoints', { name })),
                        ),
                )}
                ${profile.ownClouds().map(({ id, name }) => this.renderOwnFiles(id, name))}
                <a href="" @click=${(event: Event) => this.savePicture(event)}>SVG</a>
                <button class="quiet close" aria-label=${this.text('profile.close')} @click=${() => profile.close()}>✕</button>
            </div>
            ${profile.error ? html`<p class="told error" role="alert">${profile.error}</p>` : ''}
            <div
                class="view"
                tabindex="0"
                role="application"
                aria-label=${this.text('profile.view')}
                @keydown=${this.key}
                @wheel=${this.wheel}
                @pointerdown=${this.press}
                @pointermove=${this.hover}
                @pointerleave=${() => (this.hovered = -1)}
            >
                <canvas></canvas>
                ${this.renderAxes()}
            </div>
            <p class="told">${this.tell()}</p>
            <p class="unseen" role="status">${this.said}</p>`;
    }

    private renderChoice<T extends string>(label: string, value: T, options: [T, string][], change: (value: T) => void): TemplateResult {
        return html`<label>
            ${label}
            <select @change=${(event: Event) => change((event.target as HTMLSelectElement).value as T)}>
                ${options.map(([option, text]) => html`<option value=${option} ?selected=${option === value}>${text}</option>`)}
            </select>
        </label>`;
    }

    /** Files of a cloud that no server cuts. */
    private renderOwnFiles(id: number, name: string): TemplateResult {
        const { profile } = this, { regionFiles } = this.model, key = `profile ${id}`, running = regionFiles.of(key);
        if (running) {
            const { share, points } = running, format = running.format.toUpperCase();
            return html`<span role="status">${this.text('region.making', { format, share: Math.round(100 * share), points })}</span>
                <button @click=${() => running.cancel()}>${this.text('region.cancel')}</button>`;
        }
        const save = (format: RegionFormat): void =>
            void regionFiles.save(key, id, profile.region, format, `${name.replace(/\.stipple$/, '')}-profile`);
        return html`${ownFormats.map(
            (format) => html`<button title=${this.text('profile.allPoints', { name })} @click=${() => save(format)}>
                ${format.toUpperCase()}
            </button>`,
        )}`;
    }

    /** What is in view: all that is here, unless somebody has moved it since the profile was cut. */
    override willUpdate(_: PropertyValues): void {
        const { line, width: across, points, length, exaggeration } = this.profile, cut = JSON.stringify([line, across]);
        if (cut !== this.cut) this.isMoved = false;
        this.cut = cut;
        const width = this.area?.clientWidth ?? 0, height = this.area?.clientHeight ?? 0;
        if (width === 0 || height === 0) return; // not there yet, or hidden on a narrow page
        if (!this.isMoved || this.shown?.width !== width || this.shown.height !== height)
            this.shown = fitted({ width, height }, length, points.heights(), exaggeration);
    }

    override updated(_: PropertyValues): void {
        const { area } = this;
        if (!area || area.clientWidth === 0) return;
        if (this.shown?.width !== area.clientWidth) return this.requestUpdate(); // it is here now
        const canvas = this.renderRoot.querySelector('canvas')!, ratio = window.devicePixelRatio || 1;
        canvas.width = Math.round(this.shown.width * ratio);
        canvas.height = Math.round(this.shown.height * ratio);
        const context = canvas.getContext('2d')!, image = context.createImageData(canvas.width, canvas.height);
        draw(this.profile.points, this.colours(), this.shown, image, ratio);
        context.putImageData(image, 0, 0);
    }

    /** Made anew when the points or the mode are others. */
    private colours(): Uint32Array {
        const { points } = this.profile, { looks, style } = this.model;
        const mode = this.colour ?? this.colourModes()[0]!;
        const classes = looks.classes(), key = [mode, points.count, style.gradient, classes.length].join(' ');
        if (this.coloured?.points !== points || this.coloured.key !== key)
            this.coloured = {
                points,
                key,
                words: coloursOf(points, mode, { gradient: looks.gradients[style.gradient].colours, classes }),
            };
        return this.coloured.words;
    }

    /** That the clouds have values for. */
    private colourModes(): ProfileColour[] {
        const has = (attribute: string): boolean =>
            this.model.clouds.some(({ attributes }) => attributes?.includes(attribute));
        const needs: [ProfileColour, string?][] = [
            ['rgb', 'Red'],
            ['elevation'],
            ['classification', 'Classification'],
            ['returnNumber', 'Return Number'],
            ['intensity', 'Intensity'],
        ];
        return needs.flatMap(([mode, attribute]) => (attribute === undefined || has(attribute) ? [mode] : []));
    }

    private fit(): void {
        this.isMoved = false;
        this.requestUpdate();
    }
    private move(view: ProfileView): void {
        this.shown = view;
        this.isMoved = true;
        this.requestUpdate();
    }
    private exaggerate(value: number): void {
        this.profile.exaggerate(value);
        this.fit();
    }

    private renderAxes(): TemplateResult {
        const view = this.shown;
        if (!view) return html`<svg></svg>`;
        return html`<svg>${this.axes(view)} ${[this.marked, this.hovered].map((index) => this.renderMark(view, index))}</svg>`;
    }

    private axes(view: ProfileView): SVGTemplateResult[] {
        const corner = toProfile(view, margin.left, view.height - margin.bottom);
        const end = toProfile(view, view.width - margin.right, margin.top);
        const stations = ticks(corner.station, end.station, 1 / view.scale);
        const heights = ticks(corner.height, end.height, 1 / view.scale / view.exaggeration, 30);
        const bottom = view.height - margin.bottom, right = view.width - margin.right;
        return [
            ...stations.map((station) => {
                const { x } = toPixels(view, station, 0);
                return svg`<line class="grid" x1=${x} x2=${x} y1=${bottom} y2=${bottom + 5}></line>
                    <text x=${x} y=${bottom + 18} text-anchor="middle">${station}</text>`;
            }),
            ...heights.map((height) => {
                const { y } = toPixels(view, 0, height);
                return svg`<line class="grid" x1=${margin.left - 5} x2=${margin.left} y1=${y} y2=${y}></line>
                    <text x=${margin.left - 8} y=${y + 4} text-anchor="end">${height}</text>`;
            }),
            svg`<path class="grid" fill="none" d=${`M${margin.left} ${margin.top}V${bottom}H${right}`}></path>`,
        ];
    }

    private renderMark(view: ProfileView, index: number): SVGTemplateResult | string {
        const { points } = this.profile;
        if (index < 0 || index >= points.count) return '';
        const { x, y } = toPixels(view, points.station[index]!, points.height[index]!);
        return svg`<circle class="mark" cx=${x} cy=${y} r="5"></circle>`;
    }

    /** The point under the pointer, and how far it is from the one that was clicked. */
    private tell(): string {
        const { points } = this.profile, at = this.hovered >= 0 ? this.hovered : this.marked;
        if (at < 0 || at >= points.count) return '';
        const digits = (value: number): string => this.texts.decimals(value, 3);
        const place = this.text('profile.place', {
            station: digits(points.station[at]!),
            height: digits(points.height[at]!),
            offset: digits(points.offset[at]!),
            x: digits(points.x[at]!),
            y: digits(points.y[at]!),
        });
        if (this.marked < 0 || this.marked === at) return place;
        const along = points.station[at]! - points.station[this.marked]!;
        const up = points.height[at]! - points.height[this.marked]!;
        const apart = digits(Math.hypot(along, up));
        return this.text('profile.fromMarked', { place, along: digits(along), up: digits(up), apart });
    }

    private placeOf(event: MouseEvent): { x: number; y: number } {
        const box = this.area!.getBoundingClientRect();
        return { x: event.clientX - box.left, y: event.clientY - box.top };
    }
    private readonly wheel = (event: WheelEvent): void => {
        event.preventDefault();
        if (!this.shown) return;
        const { x, y } = this.placeOf(event);
        this.move(zoomed(this.shown, Math.exp(-Math.max(-400, Math.min(400, event.deltaY)) * 0.0015), x, y));
    };
    private readonly key = (event: KeyboardEvent): void => {
        const view = this.shown, way = ways[event.key];
        if (!view || event.ctrlKey || event.altKey || event.metaKey) return;
        if (event.shiftKey && way) this.step(view, way);
        else if (way) this.move(panned(view, keyStep * steps[event.key]![0], keyStep * steps[event.key]![1]));
        else if ('+=-'.includes(event.key)) this.move(zoomed(view, event.key === '-' ? keyZoom : 1 / keyZoom, view.width / 2, view.height / 2));
        else if (event.key === 'Home') this.fit();
        else if (event.key === 'Enter' || event.key === ' ') this.marked = this.hovered;
        else return;
        event.preventDefault();
        this.requestUpdate();
    };

    /** To the next point in a way, from the one that was come to last, or the one nearest to the middle; it comes into view. */
    private step(view: ProfileView, way: CursorWay): void {
        const { points } = this.profile;
        if (points.count === 0) return;
        this.hovered =
            this.hovered >= 0
                ? neighbour(points, this.hovered, way, columnSlack / view.scale)
                : nearest(points, view, view.width / 2, view.height / 2, Infinity);
        const { x, y } = toPixels(view, points.station[this.hovered]!, points.height[this.hovered]!);
        const into = (at: number, low: number, high: number): number => Math.max(low, Math.min(high, at)) - at;
        const dx = into(x, margin.left + 10, view.width - margin.right - 10), dy = into(y, margin.top + 10, view.height - margin.bottom - 10);
        if (dx !== 0 || dy !== 0) this.move(panned(view, dx, dy));
        this.said = this.tell();
    }

    private readonly hover = (event: PointerEvent): void => {
        if (!this.shown || event.buttons !== 0) return;
        const { x, y } = this.placeOf(event);
        this.hovered = nearest(this.profile.points, this.shown, x, y);
    };
    private readonly press = (event: PointerEvent): void => {
        if (event.button !== 0) return;
        let last = this.placeOf(event), way = 0;
        const move = (moved: PointerEvent): void => {
            const at = this.placeOf(moved);
            way += Math.hypot(at.x - last.x, at.y - last.y);
            if (this.shown && way > 3) this.move(panned(this.shown, at.x - last.x, at.y - last.y));
            last = at;
        };
        followPointer(event, move, () => {
            if (way <= 3 && this.shown) this.marked = nearest(this.profile.points, this.shown, last.x, last.y);
        });
    };

    /** What is seen, with its axes: points as a picture in it. */
    private savePicture(event: Event): void {
        event.preventDefault();
        const view = this.shown, canvas = this.renderRoot.querySelector('canvas'), axes = this.renderRoot.querySelector('svg');
        if (!view || !canvas || !axes) return;
        const style = `text{font:11px sans-serif;fill:#333}.grid{stroke:#999;fill:none}.mark{fill:none;stroke:#087;stroke-width:2}`;
        const content = new XMLSerializer().serializeToString(axes).replace(/^<svg[^>]*>|<\/svg>$/g, '').replace(/<!--.*?-->/gs, '');
        const text = `<svg xmlns="http://www.w3.org/2000/svg" width="${view.width}" height="${view.height}" viewBox="0 0 ${view.width} ${view.height}">
<style>${style}</style><rect width="100%" height="100%" fill="#fff"/>
<image href="${canvas.toDataURL('image/png')}" width="${view.width}" height="${view.height}"/>
${content}</svg>\n`;
        download(new Blob([text], { type: 'image/svg+xml' }), 'profile.svg');
    }
}

customElements.define('stipple-profile', ProfilePanel);
