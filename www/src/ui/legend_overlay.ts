import { css, html, type TemplateResult } from 'lit';

import { rangeFields, roundInSpan, ticks, unitOf } from '../looks/ranges.ts';
import type { Style } from '../wasm/values.ts';
import { ModelElement } from './model_element.ts';

/** What the colours of the picture mean: the gradient with values and their unit, or the classes. */
export class LegendOverlay extends ModelElement {
    static override styles = css`
        :host {
            display: block;
            padding: 8px 12px;
            background: var(--panel);
            border: 1px solid var(--line);
            border-radius: 10px;
            color: var(--text);
            font-size: 0.78rem;
            font-variant-numeric: tabular-nums;
            max-width: min(320px, 80vw);
        }
        :host([hidden]) {
            display: none;
        }
        h3 {
            margin: 0 0 0.35rem;
            font-size: 0.78rem;
            font-weight: 600;
        }
        .gradient {
            width: 240px;
            max-width: 100%;
            height: 12px;
            border-radius: 3px;
        }
        .ticks {
            position: relative;
            width: 240px;
            max-width: 100%;
            height: 1.5rem;
        }
        .tick {
            position: absolute;
            top: 0;
            transform: translateX(-50%);
            padding-top: 5px;
            white-space: nowrap;
        }
        .tick::before {
            content: '';
            position: absolute;
            left: 50%;
            top: 0;
            width: 1px;
            height: 4px;
            background: var(--text);
        }
        ul {
            list-style: none;
            margin: 0;
            padding: 0;
            display: grid;
            gap: 0.15rem;
        }
        li {
            display: flex;
            align-items: center;
            gap: 0.5rem;
        }
        .swatch {
            width: 0.8rem;
            height: 0.8rem;
            border-radius: 3px;
        }
    `;

    override render(): TemplateResult | string {
        const { model } = this;
        const style = model.looks.drawnStyle();
        const content = !model.looks.showsLegend || model.clouds.length === 0 ? '' : this.renderContent(style);
        this.hidden = content === '';
        return content;
    }

    private renderContent(style: Style): TemplateResult | '' {
        if (style.colourMode === 'classification') return this.renderClasses(style);
        const field = rangeFields[style.colourMode], range = field && style[field];
        if (!range) return '';
        const unit = unitOf(style, this.model.looks.facts());
        const name = style.colourMode === 'attribute' ? style.attribute : this.text(`colour.${style.colourMode}`);
        const colours = this.model.looks.gradients[style.gradient].colours.map((colour) => `rgb(${colour.join(' ')})`);
        const span = range[1] - range[0];
        return html`<h3>${unit ? this.text('legend.withUnit', { name, unit }) : name}</h3>
            <div class="gradient" .style=${`background: linear-gradient(to right, ${colours.join(', ')})`}></div>
            <div class="ticks">
                ${ticks(range, 4).map(
                    (value) =>
                        html`<span class="tick" data-tick=${value} .style=${`left: ${(100 * (value - range[0])) / span}%`}
                            >${this.texts.number(roundInSpan(value, span))}</span
                        >`,
                )}
            </div>`;
    }

    private renderClasses(style: Style): TemplateResult | '' {
        const classes = this.model.looks.classes().filter((one) => !style.hiddenClasses.includes(one.class));
        if (classes.length === 0) return '';
        return html`<h3>${this.text('classes')}</h3>
            <ul>
                ${classes.map(
                    (one) =>
                        html`<li>
                            <span class="swatch" .style=${`background: rgb(${one.colour.join(' ')})`}></span>
                            ${one.class} ${this.texts.translated('class', one.name)}
                        </li>`,
                )}
            </ul>`;
    }
}

customElements.define('stipple-legend', LegendOverlay);
