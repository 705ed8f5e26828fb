import { css, html, type TemplateResult } from 'lit';

import { ModelElement } from './model_element.ts';
import { controlStyles, factStyles } from './shared_styles.ts';

/** The counters of client/core/counters.hpp under their own names. */
export class CountersPanel extends ModelElement {
    static override styles = [
        controlStyles,
        factStyles,
        css`
            h2 {
                margin-top: 0.9rem;
            }
            h2:first-child {
                margin-top: 0;
            }
            dl {
                grid-template-columns: 1fr auto;
                margin: 0;
            }
        `,
    ];

    override render(): TemplateResult {
        const { frame, session, gpuBytes, heapBytes, decodesPending } = this.model.counters;
        const { cacheBytes = 0, compressedBytes = 0, ...others } = session;
        const memory = { cacheBytes, compressedBytes, gpuBytes, heapBytes, decodesPending };
        return html`${this.renderList(this.text('counters.frame'), frame)}
        ${this.renderList(this.text('counters.session'), others)}
        ${this.renderList(this.text('counters.memory'), memory, { ...this.model.limits })}`;
    }

    /** `limits`: of the counters of the same names. */
    private renderList(
        title: string,
        counters: Record<string, number | boolean>,
        limits: Record<string, number> = {},
    ): TemplateResult {
        return html`<h2>${title}</h2>
            <dl>
                ${Object.entries(counters).map(
                    ([name, value]) =>
                        html`<dt>${name}</dt>
                            <dd data-counter=${name}>${this.shown(name, value, limits[name])}</dd>`,
                )}
            </dl>`;
    }

    private shown(name: string, value: number | boolean, limit?: number): string {
        if (typeof value === 'boolean') return this.text(value ? 'page.yes' : 'page.no');
        if (limit !== undefined)
            return this.text('counters.ofLimit', { used: this.shown(name, value), limit: this.shown(name, limit) });
        return /bytes/i.test(name) ? this.texts.bytes(value) : this.texts.count(value);
    }
}

customElements.define('stipple-counters', CountersPanel);
