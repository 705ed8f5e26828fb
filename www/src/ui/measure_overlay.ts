import { css, html, svg, type SVGTemplateResult, type TemplateResult } from 'lit';

import { kindOf, type Measurement } from '../measuring/measurement.ts';
import { resultLines } from '../measuring/results.ts';
import type { Vector } from '../wasm/values.ts';
import { OverlayElement } from './overlay_element.ts';

type Place = { x: number; y: number };

const directions: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
/** Pixels between places that are looked at for the next point, and how far away it may be. */
const fineStep = { step: 3, reach: 60 };
const coarseStep = { step: 25, reach: 200 };

/**
 * What was measured, over the picture: lines, handles that can be dragged to other points, values. The handles of a measurement are one
 * stop of the Tab key; arrows move the one that has the focus to the next point that shows there (with shift, farther), Page Up and Page
 * Down go to the other handles.
 */
export class MeasureOverlay extends OverlayElement {
    static override styles = [
        OverlayElement.overlayStyles,
        css`
            .line {
                fill: none;
                stroke: var(--accent);
                stroke-width: 2;
                paint-order: stroke;
            }
            .under {
                fill: none;
                stroke: rgb(0 0 0 / 0.55);
                stroke-width: 4;
            }
            .inside {
                fill: var(--accent);
                fill-opacity: 0.14;
                stroke: none;
            }
            .handle {
                fill: var(--panel-solid);
                stroke: var(--accent);
                stroke-width: 2;
                pointer-events: auto;
                cursor: move;
            }
            .drawing .handle {
                pointer-events: none;
            }
            text {
                font: 600 13px system-ui, sans-serif;
                fill: #fff;
                stroke: rgb(0 0 0 / 0.75);
                stroke-width: 4;
                paint-order: stroke;
                text-anchor: middle;
            }
        `,
    ];

    private dragging = false;
    /** Moves by keys, one after the other. */
    private moves = Promise.resolve();
    private isMoving = false;
    /** Of each measurement: the handle that the Tab key comes to. */
    private readonly stops = new WeakMap<Measurement, number>();

    protected override sources(): EventTarget[] {
        return [this.model.measuring];
    }

    override render(): TemplateResult | string {
        const items = this.model.measuring.items.filter((item) => !item.hidden);
        if (items.length === 0) return '';
        const places = this.model.surface.project(items.flatMap((item) => [...corners(item), ...circle(item)]));
        let at = 0;
        const next = (count: number): (Place | null)[] => places.slice(at, (at += count));
        // While a tool is in hand, clicks are for points of the cloud, also where a handle is.
        return html`<svg class=${this.model.tool ? 'drawing' : ''}>
            ${items.map((item) => this.renderItem(item, next(corners(item).length), next(circle(item).length)))}
        </svg>`;
    }

    private renderItem(item: Measurement, points: (Place | null)[], ring: (Place | null)[]): SVGTemplateResult {
        const closed = (kindOf(item.kind).isClosed ?? false) && points.length > 2;
        const line = ring.length > 0 ? path(ring, true) : item.box ? boxPath(points) : path(points, closed);
        const stop = Math.min(this.stops.get(item) ?? 0, points.length - 1), { isDrawing } = this.model.measuring;
        return svg`<g data-kind=${item.kind}>
            ${closed && points.every(Boolean) ? svg`<path class="inside" d=${line}></path>` : ''}
            <path class="under" d=${line}></path>
            <path class="line" d=${line}></path>
            ${points.map((place, index) =>
                place && !item.box
                    ? svg`<circle class="handle" cx=${place.x} cy=${place.y} r="5" role="button"
                        tabindex=${index === stop && !isDrawing ? 0 : -1}
                        aria-label=${this.text('measure.handle', { number: index + 1, name: item.name })}
                        @focus=${() => this.stopAt(item, index)}
                        @keydown=${(event: KeyboardEvent) => this.key(event, item, index)}
                        @pointerdown=${(event: PointerEvent) => this.drag(event, item, index)}></circle>`
                    : '',
            )}
            ${this.renderLabel(item, points)}
        </g>`;
    }

    private renderLabel(item: Measurement, points: (Place | null)[]): SVGTemplateResult | string {
        const seen = points.filter((place): place is Place => place !== null);
        const first = resultLines(item, this.model.measuring.unit, this.texts)[0];
        if (!first || item.kind === 'point' || seen.length === 0) return '';
        const x = seen.reduce((sum, place) => sum + place.x, 0) / seen.length;
        const y = seen.reduce((sum, place) => sum + place.y, 0) / seen.length;
        return svg`<text aria-hidden="true" x=${x} y=${y - 10}>${first.value}</text>`;
    }

    private stopAt(item: Measurement, index: number): void {
        this.stops.set(item, index);
        this.requestUpdate();
    }

    private key(event: KeyboardEvent, item: Measurement, index: number): void {
        const direction = directions[event.key], other = { PageUp: -1, PageDown: 1 }[event.key];
        if ((!direction && !other) || event.ctrlKey || event.altKey || event.metaKey) return;
        event.preventDefault();
        if (other) {
            const handles = [...(event.currentTarget as Element).parentNode!.querySelectorAll<SVGElement>('.handle')];
            handles[(handles.indexOf(event.currentTarget as SVGElement) + other + handles.length) % handles.length]!.focus();
        } else if (!event.repeat || !this.isMoving) {
            const { step, reach } = event.shiftKey ? coarseStep : fineStep;
            this.moves = this.moves.then(() => this.moveOn(item, index, direction!, step, reach));
        }
    }
    private async moveOn(item: Measurement, index: number, direction: [number, number], step: number, reach: number): Promise<void> {
        this.isMoving = true;
        await this.model.measuring.moveOn(item, index, direction, step, reach);
        this.isMoving = false;
    }

    /** The handle follows the pointer from point to point; one question at a time, the last place counts. */
    private drag(event: PointerEvent, item: Measurement, index: number): void {
        const box = this.model.canvas.getBoundingClientRect();
        let wanted: Place | undefined;
        const ask = async (): Promise<void> => {
            if (this.dragging) return;
            this.dragging = true;
            while (wanted) {
                const { x, y } = wanted;
                wanted = undefined;
                await this.model.measuring.move(item, index, x, y);
            }
            this.dragging = false;
        };
        this.followPointer(event, (moved) => {
            wanted = { x: moved.clientX - box.left, y: moved.clientY - box.top };
            void ask();
        });
    }
}

function corners(item: Measurement): Vector[] {
    return item.points.map((point) => point.position);
}

/** Places around the circle that was measured. */
function circle(item: Measurement): Vector[] {
    const { answer } = item;
    if (item.kind !== 'circle' || !answer) return [];
    const centre = answer['centre'] as Vector, normal = answer['normal'] as Vector, radius = answer['radius'] as number;
    const first = item.points[0]!.position.map((value, axis) => (value - centre[axis]!) / radius) as Vector;
    const second = cross(normal, first);
    return Array.from({ length: 72 }, (_, i) => {
        const c = radius * Math.cos((i * Math.PI) / 36), s = radius * Math.sin((i * Math.PI) / 36);
        return centre.map((value, axis) => value + c * first[axis]! + s * second[axis]!) as Vector;
    });
}

function cross([a, b, c]: Vector, [x, y, z]: Vector): Vector {
    return [b * z - c * y, c * x - a * z, a * y - b * x];
}

/** Through the places, interrupted where one is behind the camera. */
function path(places: (Place | null)[], closed: boolean): string {
    let isOn = false;
    const steps = places.map((place) => {
        if (!place) {
            isOn = false;
            return '';
        }
        const step = `${isOn ? 'L' : 'M'}${place.x} ${place.y}`;
        isOn = true;
        return step;
    });
    return steps.join('') + (closed && places.every(Boolean) ? 'Z' : '');
}

/** The edges between the corners of a box: two whose numbers differ in one bit. */
function boxPath(corners: (Place | null)[]): string {
    return corners
        .flatMap((from, at) => [1, 2, 4].map((bit) => (at & bit ? '' : path([from, corners[at | bit] ?? null], false))))
        .join('');
}

customElements.define('stipple-measure-overlay', MeasureOverlay);
