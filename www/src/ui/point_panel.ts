import { css, html, type TemplateResult } from 'lit';

import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** The point that was clicked: coordinates and every attribute, as the file has them. */
export class PointPanel extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            header {
                display: flex;
                justify-content: space-between;
                align-items: center;
                gap: 0.8rem;
            }
            h2 {
                margin: 0;
            }
            dl {
                display: grid;
                grid-template-columns: auto 1fr;
                gap: 0.15rem 1.2rem;
                margin: 0.6rem 0 0;
                font-size: 0.82rem;
                user-select: text;
            }
            dt {
                color: var(--muted);
            }
            dd {
                margin: 0;
                text-align: right;
                font-variant-numeric: tabular-nums;
                overflow-wrap: anywhere;
            }
        `,
    ];

    override render(): TemplateResult | string {
        const picked = this.model.picking.point;
        if (!picked) return '';
        const [x, y, z] = picked.position;
        return html`<header>
                <h2>Point</h2>
                <button class="quiet" aria-label="Close the point" @click=${() => this.model.picking.forget()}>✕</button>
            </header>
            <dl>
                ${row('X', x)} ${row('Y', y)} ${row('Z', z)}
                ${Object.entries(picked.values).map(([name, value]) => row(name, value))}
                ${picked.crs ? row('CRS', picked.crs) : ''} ${row('Cloud', picked.cloudName)}
                ${row('Node', `${picked.point.node}, ${picked.point.index}`)}
            </dl>`;
    }
}

function row(name: string, value: number | number[] | string): TemplateResult {
    const text = Array.isArray(value) ? value.join(', ') : String(value);
    return html`<dt>${name}</dt>
        <dd data-value=${name}>${text}</dd>`;
}

customElements.define('stipple-point', PointPanel);
