import { css, html, type PropertyValues, svg, type SVGTemplateResult, type TemplateResult } from 'lit';

import type { Profile } from '../profile/profile.ts';
import { draw, fitted, margin, nearest, panned, type ProfileView, ticks, toPixels, toProfile, zoomed } from '../profile/profile_view.ts';
import type { RegionFormat } from '../wasm/values.ts';
import { download } from './download.ts';
import { followPointer } from './follow_pointer.ts';
import { ModelElement } from './model_element.ts';
import { servedLink } from './served_link.ts';
import { controlStyles } from './shared_styles.ts';

const formats = ['laz', 'las', 'csv'];
const ownFormats: RegionFormat[] = ['laz', 'las', 'csv'];

/** The 2D view of a profile: station to the right, height upwards; drag moves, wheel zooms, a click takes a point to measure from. */
export class ProfilePanel extends ModelElement {
    static override properties = {
        ...ModelElement.properties,
        exaggeration: { state: true },
        hovered: { state: true },
        marked: { state: true },
    };
    declare exaggeration: number;
    /** Index of the point under the pointer, and of the one that was clicked; -1: none. */
    declare hovered: number;
    declare marked: number;

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
    private fittedLength = -1;
    private readonly letGo = (): void => void (this.hovered = this.marked = -1);

    constructor() {
        super();
        this.exaggeration = 1;
        this.hovered = this.marked = -1;
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
                        .value=${String(this.exaggeration)}
                        @change=${(event: Event) => this.exaggerate((event.target as HTMLInputElement).valueAsNumber)}
                    />
                </label>
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
                ${this.model.clipping.cloudsWithoutApi().map(({ id, name }) => this.renderOwnFiles(id, name))}
                <a href="" @click=${(event: Event) => this.savePicture(event)}>SVG</a>
                <button class="quiet close" aria-label=${this.text('profile.close')} @click=${() => profile.close()}>✕</button>
            </div>
            ${profile.error ? html`<p class="told error" role="alert">${profile.error}</p>` : ''}
            <div
                class="view"
                @wheel=${this.wheel}
                @pointerdown=${this.press}
                @pointermove=${this.hover}
                @pointerleave=${() => (this.hovered = -1)}
            >
                <canvas></canvas>
                ${this.renderAxes()}
            </div>
            <p class="told">${this.tell()}</p>`;
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

    override updated(_: PropertyValues): void {
        const { area } = this;
        if (!area) return;
        const width = area.clientWidth, height = area.clientHeight;
        if (width === 0 || height === 0) return; // hidden, on a narrow page
        const isNew = this.profile.length !== this.fittedLength && this.profile.points.count > 0;
        if (!this.shown || isNew || this.shown.width !== width || this.shown.height !== height) {
            if (isNew) this.fittedLength = this.profile.length;
            this.fit();
            return;
        }
        const canvas = this.renderRoot.querySelector('canvas')!, ratio = window.devicePixelRatio || 1;
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
        const context = canvas.getContext('2d')!, image = context.createImageData(canvas.width, canvas.height);
        draw(this.profile.points, this.shown, image, ratio);
        context.putImageData(image, 0, 0);
    }

    private fit(): void {
        const { area } = this;
        if (!area || !this.profile.isOpen) return;
        const size = { width: area.clientWidth, height: area.clientHeight };
        this.shown = fitted(size, this.profile.length, this.profile.points.heights(), this.exaggeration);
        this.requestUpdate();
    }
    private exaggerate(value: number): void {
        if (value >= 0.1 && value <= 100) this.exaggeration = value;
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
        this.shown = zoomed(this.shown, Math.exp(-Math.max(-400, Math.min(400, event.deltaY)) * 0.0015), x, y);
        this.requestUpdate();
    };
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
            if (this.shown && way > 3) this.shown = panned(this.shown, at.x - last.x, at.y - last.y);
            last = at;
            this.requestUpdate();
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
