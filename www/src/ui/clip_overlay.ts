import { html, svg, type SVGTemplateResult, type TemplateResult } from 'lit';

import { axesOf, cornersOf, edges, headingOf, placeIn, withCentre, withFaceMoved, withHeading } from '../clipping/boxes.ts';
import { along, inPlane, type Place } from '../clipping/handles.ts';
import type { ClipBox, Vector } from '../wasm/values.ts';
import { OverlayElement } from './overlay_element.ts';
import { clipStyles, RegionDrawing } from './region_drawing.ts';

/**
 * Clip boxes and regions over the picture, and the polygon that is drawn. The box that is edited has handles: a side each, the
 * middle moves it, the knob turns it.
 */
export class ClipOverlay extends OverlayElement {
    static override styles = [
        OverlayElement.overlayStyles,
        clipStyles,
    ];

    private readonly regions = new RegionDrawing(
        () => this.model,
        (event, follow) => this.followPointer(event, follow),
    );

    override render(): TemplateResult {
        return html`<svg aria-hidden="true" class=${this.model.tool ? 'drawing' : ''}>
            ${this.model.clipping.boxes.map((box, index) => this.renderBox(box, index))} ${this.regions.render()}
        </svg>`;
    }

    private renderBox(box: ClipBox, index: number): SVGTemplateResult {
        const isSelected = this.model.clipping.isSelected({ box: index });
        const corners = this.model.surface.project(cornersOf(box));
        const line = edges
            .map(([a, b]) => [corners[a], corners[b]])
            .map(([a, b]) => (a && b ? `M${a.x} ${a.y}L${b.x} ${b.y}` : ''))
            .join('');
        return svg`<g class=${isSelected ? 'selected' : ''} data-clip=${index}>
            <path class="edges" d=${line}></path>
            ${isSelected ? this.renderHandles(box, index) : ''}
        </g>`;
    }

    private renderHandles(box: ClipBox, index: number): SVGTemplateResult[] {
        const faces = [0, 1, 2].flatMap((axis) =>
            [1, -1].map((sign) => ({ axis, sign, place: placeIn(box, faceOf(box, axis, sign)) })),
        );
        const knob = placeIn(box, [1.4 * box.halfSize[0], 0, 0]);
        const shown = this.model.surface.project([...faces.map(({ place }) => place), box.centre, knob]);
        const centre = shown[6], turner = headingOf(box) === undefined ? null : shown[7];
        const drag = (move: (event: PointerEvent, box: ClipBox, step: Place) => ClipBox | undefined) =>
            (event: PointerEvent): void => this.drag(event, index, move);
        return [
            ...faces.flatMap(({ axis, sign }, i) => {
                const at = shown[i];
                if (!at) return [];
                const move = (_: PointerEvent, from: ClipBox, step: Place): ClipBox =>
                    withFaceMoved(from, axis, sign, along(step, this.pixelsOf(from, axis, sign)));
                return svg`<rect class="handle" data-face=${`${'xyz'[axis]}${sign > 0 ? '+' : '-'}`}
                    x=${at.x - 5} y=${at.y - 5} width="10" height="10" @pointerdown=${drag(move)}></rect>`;
            }),
            ...(turner && centre
                ? [
                      svg`<line class="arm" x1=${centre.x} y1=${centre.y} x2=${turner.x} y2=${turner.y}></line>
                        <circle class="handle" data-handle="turn" cx=${turner.x} cy=${turner.y} r="6"
                            @pointerdown=${drag((event, from) => this.turned(event, from))}></circle>`,
                  ]
                : []),
            ...(centre
                ? [
                      svg`<circle class="handle" data-handle="centre" cx=${centre.x} cy=${centre.y} r="7"
                        @pointerdown=${drag((_, from, step) => this.shifted(from, step))}></circle>`,
                  ]
                : []),
        ];
    }

    /** How one world unit outwards from a side, or along an axis, shows there. */
    private pixelsOf(box: ClipBox, axis: number, sign: number): Place {
        return this.pixelsAlong(box, faceOf(box, axis, sign), axis, sign);
    }
    private pixelsAlong(box: ClipBox, from: Vector, axis: number, sign: number): Place {
        const unit = 0.05 * box.halfSize[axis]!;
        const to = from.map((value, at) => (at === axis ? value + sign * unit : value)) as Vector;
        const [a, b] = this.model.surface.project([placeIn(box, from), placeIn(box, to)]);
        return a && b ? { x: (b.x - a.x) / unit, y: (b.y - a.y) / unit } : { x: 0, y: 0 };
    }

    /** Along its own x and y, or, seen from the side, along z and the one of them that shows. */
    private shifted(box: ClipBox, step: Place): ClipBox | undefined {
        const pixels = [0, 1, 2].map((axis) => this.pixelsAlong(box, [0, 0, 0], axis, 1));
        const pairs: [number, number][] = [
            [0, 1],
            [0, 2],
            [1, 2],
        ];
        for (const [a, b] of pairs) {
            const ways = inPlane(step, pixels[a]!, pixels[b]!);
            if (!ways) continue;
            const move: Vector = [0, 0, 0];
            move[a] = ways[0];
            move[b] = ways[1];
            return withCentre(box, placeIn(box, move));
        }
        return undefined;
    }

    /** The knob comes to lie in the direction of the pointer. */
    private turned(event: PointerEvent, box: ClipBox): ClipBox | undefined {
        const area = this.model.canvas.getBoundingClientRect();
        const [centre] = this.model.surface.project([box.centre]);
        if (!centre) return undefined;
        const step = { x: event.clientX - area.left - centre.x, y: event.clientY - area.top - centre.y };
        const ways = inPlane(step, this.pixelsAlong(box, [0, 0, 0], 0, 1), this.pixelsAlong(box, [0, 0, 0], 1, 1));
        if (!ways) return undefined;
        const [x, y] = axesOf(box);
        const way = [ways[0] * x[0] + ways[1] * y[0], ways[0] * x[1] + ways[1] * y[1]];
        const degrees = (Math.atan2(way[1]!, way[0]!) * 180) / Math.PI;
        return withHeading(box, event.shiftKey ? Math.round(degrees / 15) * 15 : degrees);
    }

    private drag(
        event: PointerEvent,
        index: number,
        move: (event: PointerEvent, box: ClipBox, step: Place) => ClipBox | undefined,
    ): void {
        let last = { x: event.clientX, y: event.clientY };
        this.followPointer(event, (moved) => {
            const box = this.model.clipping.boxes[index];
            const next = box && move(moved, box, { x: moved.clientX - last.x, y: moved.clientY - last.y });
            last = { x: moved.clientX, y: moved.clientY };
            if (next) this.model.clipping.change(index, next);
        });
    }
}

function faceOf(box: ClipBox, axis: number, sign: number): Vector {
    const place: Vector = [0, 0, 0];
    place[axis] = sign * box.halfSize[axis]!;
    return place;
}

customElements.define('stipple-clip-overlay', ClipOverlay);
