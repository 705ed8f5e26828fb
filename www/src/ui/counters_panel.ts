import { css, html, type TemplateResult } from 'lit';

import { formatBytes, formatCount, ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** The counters of client/core/counters.hpp under their own names. */
export class CountersPanel extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            h2 {
                margin-top: 0.9rem;
            }
            h2:first-child {
                margin-top: 0;
            }
            dl {
                display: grid;
                grid-template-columns: 1fr auto;
                gap: 0.15rem 1.2rem;
                margin: 0;
                font-size: 0.82rem;
            }
            dt {
                color: var(--muted);
            }
            dd {
                margin: 0;
                text-align: right;
                font-variant-numeric: tabular-nums;
            }
        `,
    ];

    override render(): TemplateResult {
        const { frame, session, gpuBytes, heapBytes, decodesPending } = this.model.counters;
        return html`${this.renderList('Frame', frame)} ${this.renderList('Session', session)}
        ${this.renderList('Memory', { gpuBytes, heapBytes, decodesPending })}`;
    }

    private renderList(title: string, counters: Record<string, number | boolean>): TemplateResult {
        return html`<h2>${title}</h2>
            <dl>
                ${Object.entries(counters).map(
                    ([name, value]) =>
                        html`<dt>${name}</dt>
                            <dd data-counter=${name}>${shown(name, value)}</dd>`,
                )}
            </dl>`;
    }
}

function shown(name: string, value: number | boolean): string {
    if (typeof value === 'boolean') return value ? 'yes' : 'no';
    return /bytes/i.test(name) ? formatBytes(value) : formatCount(value);
}

customElements.define('stipple-counters', CountersPanel);
