import { css, svg, type SVGTemplateResult } from 'lit';

import type { Place } from '../clipping/handles.ts';
import { atHeight, heightsShown } from '../clipping/regions.ts';
import type { Model } from '../model.ts';
import type { ClipRegion, RegionOf, ScreenPolygon, Vector } from '../wasm/values.ts';

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
    }
    .drawing .handle {
        pointer-events: none;
    }
    .handle.new {
        fill-opacity: 0.45;
    }
    @media (pointer: coarse) {
        circle.handle {
            r: 10px;
        }
    }
    .arm {
        stroke: #ffd479;
        stroke-dasharray: 3 3;
    }
`;

type Shown = Place | null;

/** Clip regions as lines over the picture, and the polygon that is drawn. */
export class RegionDrawing {
    constructor(private readonly modelOf: () => Model) {}

    render(): SVGTemplateResult[] {
        const { regions } = this.model.clipping;
        return [...regions.map((clip, index) => this.renderRegion(clip, index)), ...this.renderTool()];
    }

    private get model(): Model {
        return this.modelOf();
    }

    private renderRegion(clip: ClipRegion, index: number): SVGTemplateResult {
        const { region } = clip, isSelected = this.model.clipping.isSelected({ region: index });
        const [low, high] = heightsShown(region, this.model.clouds);
        const lines =
            'prism' in region
                ? this.prism(region.prism)
                : ringsOf(region).map((ring) =>
                      this.wall(ring, low, high, 'polygon' in region),
                  );
        return svg`<g class=${isSelected ? 'selected' : ''} data-region=${index}>
            ${lines.map((line) => svg`<path class="edges" d=${line}></path>`)}
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
}

/** In plan: of a corridor its line. */
function ringsOf(region: RegionOf): [number, number][][] {
    if ('polygon' in region) return [region.polygon, ...(region.holes ?? [])];
    return 'line' in region ? [region.line] : [];
}

/** Through the places, interrupted where one is behind the camera. */
function path(places: readonly Shown[], isClosed: boolean): string {
    const ring = isClosed && places.length > 2 ? [...places, places[0]!] : places;
    return ring
        .map((at, i) => (at ? `${i > 0 && ring[i - 1] ? 'L' : 'M'}${at.x} ${at.y}` : ''))
        .join('');
}
