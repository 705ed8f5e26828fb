import { css, html, type PropertyValues, type TemplateResult } from 'lit';

import { coloursOf, type ProfileColour } from '../profile/profile_colours.ts';
import { type CursorWay, neighbour } from '../profile/profile_cursor.ts';
import type { Profile } from '../profile/profile.ts';
import type { ProfilePoints } from '../profile/profile_points.ts';
import { draw, fitted, margin, nearest, panned, type ProfileView, toPixels, zoomed } from '../profile/profile_view.ts';
import { followPointer } from './follow_pointer.ts';
import { ModelElement } from './model_element.ts';
import { axes, mark, pictureOf } from './profile_axes.ts';
import { controlStyles } from './shared_styles.ts';

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
export class ProfileChart extends ModelElement {
    static override properties = {
        ...ModelElement.properties,
        colour: { attribute: false },
        hovered: { state: true },
        marked: { state: true },
        said: { state: true },
    };
    declare colour: ProfileColour;
    /** Index of the point under the pointer, and of the one that was clicked; -1: none. */
    declare hovered: number;
    declare marked: number;
    /** Of the point that the keys came to, for those who do not see it. */
    declare said: string;

    static override styles = [
        controlStyles,
        css`
            :host {
                display: block;
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
        return [this.profile];
    }

    private get profile(): Profile {
        return this.model.profile;
    }
    private get area(): HTMLElement | null {
        return this.renderRoot.querySelector<HTMLElement>('.view');
    }

    override render(): TemplateResult {
        return html`<div
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
        const { colour } = this, classes = looks.classes(), key = [colour, points.count, style.gradient, classes.length].join(' ');
        if (this.coloured?.points !== points || this.coloured.key !== key)
            this.coloured = {
                points,
                key,
                words: coloursOf(points, colour, { gradient: looks.gradients[style.gradient].colours, classes }),
            };
        return this.coloured.words;
    }

    /** All that is here comes into view. */
    fit(): void {
        this.isMoved = false;
        this.requestUpdate();
    }
    private move(view: ProfileView): void {
        this.shown = view;
        this.isMoved = true;
        this.requestUpdate();
    }
    /** What is seen, as an SVG file. */
    picture(): Blob | undefined {
        const canvas = this.renderRoot.querySelector('canvas'), svg = this.renderRoot.querySelector('svg');
        return this.shown && canvas && svg ? pictureOf(this.shown, canvas, svg) : undefined;
    }

    private renderAxes(): TemplateResult {
        const view = this.shown;
        if (!view) return html`<svg></svg>`;
        return html`<svg>${axes(view)} ${[this.marked, this.hovered].map((index) => mark(view, this.profile.points, index))}</svg>`;
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
}

customElements.define('stipple-profile-chart', ProfileChart);
