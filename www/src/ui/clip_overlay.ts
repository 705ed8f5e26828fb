import { html, svg, type SVGTemplateResult, type TemplateResult } from 'lit';

import { boxHandles } from '../clipping/box_handles.ts';
import { cornersOf, edges } from '../clipping/boxes.ts';
import type { Handle } from '../clipping/handles.ts';
import { regionHandles } from '../clipping/region_handles.ts';
import type { ClipBox } from '../wasm/values.ts';
import { HandleDrawing } from './handle_drawing.ts';
import { OverlayElement } from './overlay_element.ts';
import { clipStyles, RegionDrawing } from './region_drawing.ts';

/** Clip boxes and regions over the picture, the handles of the one that is edited, and the polygon that is drawn. */
export class ClipOverlay extends OverlayElement {
    static override styles = [
        OverlayElement.overlayStyles,
        clipStyles,
    ];

    private readonly regions = new RegionDrawing(() => this.model);
    private readonly handles = new HandleDrawing(this);

    override render(): TemplateResult {
        const handles = this.handlesOfSelected(), isFree = !this.model.tool, arms = this.renderArms(handles);
        return html`<svg class=${isFree ? '' : 'drawing'}>
            ${this.model.clipping.boxes.map((box, index) => this.renderBox(box, index))} ${this.regions.render()}
            ${handles.length > 0 ? svg`<g>${arms}${this.handles.render(handles, isFree)}</g>` : ''}
        </svg>`;
    }

    private handlesOfSelected(): Handle[] {
        const { model } = this, { clipping } = model, { selected } = clipping;
        if (!selected) return [];
        if ('box' in selected) return boxHandles(model, selected.box, this.text('clip.box', { number: selected.box + 1 }));
        return clipping.regions[selected.region] ? regionHandles(model, selected.region, clipping.nameOfRegion(selected.region)) : [];
    }

    private renderBox(box: ClipBox, index: number): SVGTemplateResult {
        const corners = this.model.surface.project(cornersOf(box));
        const line = edges
            .map(([a, b]) => [corners[a], corners[b]])
            .map(([a, b]) => (a && b ? `M${a.x} ${a.y}L${b.x} ${b.y}` : ''))
            .join('');
        return svg`<g class=${this.model.clipping.isSelected({ box: index }) ? 'selected' : ''} data-clip=${index}>
            <path class="edges" d=${line}></path>
        </g>`;
    }

    /** From a box's middle to its knobs. */
    private renderArms(handles: Handle[]): SVGTemplateResult[] {
        const centre = handles.find(({ which }) => which === 'centre')?.at;
        const knobs = handles.filter(({ kind, which }) => kind === 'handle' && which !== 'centre');
        return centre ? knobs.map(({ at }) => svg`<line class="arm" x1=${centre.x} y1=${centre.y} x2=${at.x} y2=${at.y}></line>`) : [];
    }
}

customElements.define('stipple-clip-overlay', ClipOverlay);
