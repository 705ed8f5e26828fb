import { css, svg, type SVGTemplateResult } from 'lit';

import { inPlane, type Place } from '../clipping/handles.ts';
import { atHeight, heightsShown, withCorner } from '../clipping/regions.ts';
import type { Model } from '../model.ts';
import type { ClipRegion, ScreenPolygon, Vector } from '../wasm/values.ts';

export const clipStyles = css`
    .edges {
        fill: none;
        stroke: #ffd479;
        stroke-width: 1.5;
        stroke-opacity: 0.55;
    }
    .selected .edges,
    .drawn .edges {
        stroke-opacity: 1;
    }
    .handle {
        fill: #ffd479;
        stroke: rgb(0 0 0 / 0.6);
        stroke-width: 1.5;
        pointer-events: auto;
        cursor: move;
        touch-action: none;
    }
    .drawing .handle {
        pointer-events: none;
    }
    .arm {
        stroke: #ffd479;
        stroke-dasharray: 3 3;
    }
`;

type Shown = Place | null;

/** Clip regions as lines over the picture, with handles for the corners of the one that is edited; and the polygon that is drawn. */
export class RegionDrawing {
    constructor(
        private readonly modelOf: () => Model,
        private readonly followPointer: (event: PointerEvent, follow: (moved: PointerEvent) => void) => void,
    ) {}

    render(): SVGTemplateResult[] {
        const { regions } = this.model.clipping;
        return [...regions.map((clip, index) => this.renderRegion(clip, index)), ...this.renderTool()];
    }

    private get model(): Model {
        return this.modelOf();
    }

    private renderRegion(clip: ClipRegion, index: number): SVGTemplateResult {
        const { region } = clip, isSelected = this.model.clipping.isSelected({ region: index });
        const corners = 'polygon' in region ? region.polygon : 'line' in region ? region.line : [];
        const [low, high] = heightsShown(region, this.model.clouds);
        const lines =
            'prism' in region
                ? this.prism(region.prism)
                : [...('polygon' in region ? [region.polygon, ...(region.holes ?? [])] : [corners])].map((ring) =>
                      this.wall(ring, low, high, 'polygon' in region),
                  );
        return svg`<g class=${isSelected ? 'selected' : ''} data-region=${index}>
            ${lines.map((line) => svg`<path class="edges" d=${line}></path>`)}
            ${isSelected
                ? this.show(atHeight(corners, low)).map((at, corner) =>
                      at
                          ? svg`<circle class="handle" data-corner=${corner} cx=${at.x} cy=${at.y} r="6"
                                @pointerdown=${(event: PointerEvent) => this.drag(event, index, corner, low)}></circle>`
                          : '',
                  )
                : ''}
        </g>`;
    }

    /** What is drawn, and where the keyboard sets the next corner. */
    private renderTool(): SVGTemplateResult[] {
        const { tool } = this.model.clipping;
        if (!tool) return [];
        const places = tool.kind === 'ground' ? this.show(tool.ground) : tool.screen, { x, y } = tool.cursor;
        return [
            svg`<g class="drawn" data-drawn=${places.length}>
                <path class="edges" d=${path(places, true)}></path>
                ${places.map((at) => (at ? svg`<circle class="handle" cx=${at.x} cy=${at.y} r="4"></circle>` : ''))}
                ${tool.kind === 'screen' ? svg`<path class="edges" d=${`M${x - 9} ${y}h18M${x} ${y - 9}v18`}></path>` : ''}
            </g>`,
        ];
    }

    /** A ring, or an open line, at two heights, and what joins the two. */
    private wall(corners: [number, number][], low: number, high: number, isClosed: boolean): string {
        const bottom = this.show(atHeight(corners, low)), top = this.show(atHeight(corners, high));
        return path(bottom, isClosed) + path(top, isClosed) + bottom.map((at, i) => path([at, top[i]!], false)).join('');
    }

    /** The polygon where its corners lie, and the rays from the eye. */
    private prism({ eye, corners }: ScreenPolygon): string[] {
        const ring = this.show(corners), [from] = eye ? this.show([eye]) : [null];
        return [path(ring, true) + (from ? ring.map((at) => path([from, at], false)).join('') : '')];
    }

    private show(places: Vector[]): Shown[] {
        return places.length > 0 ? this.model.surface.project(places) : [];
    }

    /** The corner stays at its height and follows the pointer; seen from the side of that plane it stays. */
    private drag(event: PointerEvent, index: number, corner: number, z: number): void {
        let last = { x: event.clientX, y: event.clientY };
        this.followPointer(event, (moved) => {
            const { clipping } = this.model, clip = clipping.regions[index];
            const step = { x: moved.clientX - last.x, y: moved.clientY - last.y };
            last = { x: moved.clientX, y: moved.clientY };
            const corners = clip && ('polygon' in clip.region ? clip.region.polygon : 'line' in clip.region ? clip.region.line : []);
            const from = corners?.[corner];
            if (!clip || !from) return;
            const way = this.wayOf(step, [from[0], from[1], z], extent(corners));
            if (way) clipping.changeRegion(index, withCorner(clip, corner, [from[0] + way[0], from[1] + way[1]]));
        });
    }

    /** World units along x and y for a step of the pointer at a place. */
    private wayOf(step: Place, [x, y, z]: Vector, size: number): [number, number] | undefined {
        const unit = 0.02 * size;
        const [at, right, up] = this.show([[x, y, z], [x + unit, y, z], [x, y + unit, z]]);
        if (!at || !right || !up) return undefined;
        const pixels = (to: Place): Place => ({ x: (to.x - at.x) / unit, y: (to.y - at.y) / unit });
        return inPlane(step, pixels(right), pixels(up));
    }
}

function extent(corners: [number, number][]): number {
    const xs = corners.map(([x]) => x), ys = corners.map(([, y]) => y);
    return Math.max(...xs) - Math.min(...xs) + Math.max(...ys) - Math.min(...ys) || 1;
}

/** Through the places, interrupted where one is behind the camera. */
function path(places: readonly Shown[], isClosed: boolean): string {
    const ring = isClosed && places.length > 2 ? [...places, places[0]!] : places;
    return ring
        .map((at, i) => (at ? `${i > 0 && ring[i - 1] ? 'L' : 'M'}${at.x} ${at.y}` : ''))
        .join('');
}
