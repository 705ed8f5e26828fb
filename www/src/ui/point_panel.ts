import { css, html, type TemplateResult } from 'lit';

import type { LonLat } from '../map/projection.ts';
import type { PickedPoint } from '../wasm/values.ts';
import { ModelElement } from './model_element.ts';
import { panelHead } from './panel_head.ts';
import { controlStyles, factStyles, headStyles } from './shared_styles.ts';

/** The point that was clicked: coordinates and every attribute, as the file has them. */
export class PointPanel extends ModelElement {
    static override styles = [
        controlStyles,
        headStyles,
        factStyles,
        css`
            /* Numbers stay whole: names give way. */
            dl {
                grid-template-columns: minmax(0, auto) minmax(min-content, 1fr);
                column-gap: 0.8rem;
            }
            .number {
                white-space: nowrap;
            }
        `,
    ];

    /** Of the point that is shown; null: it has none that is known. */
    private lonLat: LonLat | null = null;
    private located: PickedPoint | null = null;

    override willUpdate(): void {
        const picked = this.model.picking.point;
        if (picked === this.located) return;
        this.located = picked;
        this.lonLat = null;
        if (picked) void this.locate(picked);
    }
    private async locate(picked: PickedPoint): Promise<void> {
        const lonLat = await this.model.geography.lonLat(picked);
        if (picked !== this.located) return;
        this.lonLat = lonLat;
        this.requestUpdate();
    }

    override render(): TemplateResult | string {
        const picked = this.model.picking.point;
        if (!picked) return '';
        const [x, y, z] = picked.position;
        return html`${panelHead(this.text('point'), this.text('point.close'), () => this.model.picking.forget())}
            <dl>
                ${this.row('X', 'X', x)} ${this.row('Y', 'Y', y)} ${this.row('Z', 'Z', z)}
                ${this.lonLat
                    ? html`${this.row('Longitude', this.text('point.longitude'), degrees(this.lonLat[0]))}
                      ${this.row('Latitude', this.text('point.latitude'), degrees(this.lonLat[1]))}`
                    : ''}
                ${Object.entries(picked.values).map(([name, value]) => this.row(name, name, value))}
                ${picked.crs ? this.row('CRS', this.text('point.crs'), picked.crs) : ''} ${this.row('Cloud', this.text('point.cloud'), picked.cloudName)}
                ${this.row('Node', this.text('point.node'), `${picked.point.node}, ${picked.point.index}`)}
            </dl>`;
    }

    private row(field: string, name: string, value: number | number[] | string): TemplateResult {
        const shown = (one: number): string => this.texts.number(one);
        const text = Array.isArray(value) ? value.map(shown).join(', ') : typeof value === 'number' ? shown(value) : value;
        return html`<dt>${name}</dt>
            <dd class=${typeof value === 'number' ? 'number' : ''} data-value=${field}>${text}</dd>`;
    }
}

/** To a millimetre on the ground. */
function degrees(value: number): number {
    return Number(value.toFixed(8));
}

customElements.define('stipple-point', PointPanel);
