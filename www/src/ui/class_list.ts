import { css, html, type TemplateResult } from 'lit';

import { classRequest } from '../looks/ranges.ts';
import type { CloudClass } from '../wasm/values.ts';
import { Counted } from './counted.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** The classes of all clouds together: each can be hidden, and says how many of its points are in view, of how many. */
export class ClassList extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            ul {
                list-style: none;
                margin: 0.35rem 0 0;
                padding: 0;
            }
            li label {
                display: grid;
                grid-template-columns: auto auto 1fr auto;
                align-items: center;
                gap: 0.5rem;
                min-height: 1.75rem;
            }
            .swatch {
                width: 0.9rem;
                height: 0.9rem;
                border-radius: 3px;
            }
            .points {
                color: var(--muted);
                font-variant-numeric: tabular-nums;
            }
            .all {
                display: flex;
                gap: 0.4rem;
                margin-top: 0.3rem;
            }
            .all button {
                min-height: 1.75rem;
                font-size: 0.82rem;
            }
        `,
    ];

    private readonly counted = new Counted(this, () => classRequest);

    override render(): TemplateResult {
        const classes = this.model.looks.classes();
        return html`<fieldset>
            <legend>${this.text('classes')}</legend>
            <ul>
                ${classes.map((one) => this.renderClass(one))}
            </ul>
            <div class="all">
                <button @click=${() => this.model.changeStyle({ hiddenClasses: [] })}>${this.text('classes.every')}</button>
                <button @click=${() => this.model.changeStyle({ hiddenClasses: classes.map((one) => one.class) })}>${this.text('classes.none')}</button>
            </div>
        </fieldset>`;
    }

    private renderClass(one: CloudClass): TemplateResult {
        const hidden = new Set(this.model.style.hiddenClasses);
        const show = (isShown: boolean): void => {
            if (isShown) hidden.delete(one.class);
            else hidden.add(one.class);
            this.model.changeStyle({ hiddenClasses: [...hidden] });
        };
        const histogram = this.counted.histogram, inView = histogram && (histogram.bins[one.class] ?? 0);
        const all = this.texts.compact(one.points), name = this.texts.translated('class', one.name);
        return html`<li>
            <label>
                <input
                    type="checkbox"
                    aria-label=${this.text('classes.label', { number: one.class, name })}
                    .checked=${!hidden.has(one.class)}
                    @change=${(event: Event) => show((event.target as HTMLInputElement).checked)}
                />
                <span class="swatch" .style=${`background: rgb(${one.colour.join(',')})`}></span>
                <span>${one.class} ${name}</span>
                <span
                    class="points"
                    data-class=${one.class}
                    data-in-view=${inView ?? ''}
                    title=${inView === undefined ? '' : this.text('classes.inViewHint', { inView, all: one.points })}
                    >${inView === undefined ? all : this.text('classes.inView', { inView: this.texts.compact(inView), all })}</span
                >
            </label>
        </li>`;
    }
}

customElements.define('stipple-classes', ClassList);
