import { css, html, type TemplateResult } from 'lit';

import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** How much is drawn and was fetched; asks for the counters, or for them to be closed, by the event 'counters'. */
export class StatusLine extends ModelElement {
    static override properties = { ...ModelElement.properties, countersAreOpen: { attribute: false } };
    declare countersAreOpen: boolean;

    static override styles = [
        controlStyles,
        css`
            :host {
                display: flex;
                align-items: center;
                gap: 0.4rem;
                padding: 2px 4px 2px 12px;
                background: var(--panel);
                border: 1px solid var(--line);
                border-radius: 999px;
                font-size: 0.85rem;
                font-variant-numeric: tabular-nums;
                color: var(--muted);
                white-space: nowrap;
            }
            span {
                unicode-bidi: plaintext;
            }
            button {
                border-radius: 999px;
                min-height: 1.75rem;
            }
        `,
    ];

    override render(): TemplateResult {
        const { frame, session } = this.model.counters, drawn = Number(frame['pointsDrawn']);
        return html`<span>${this.text('page.points', { count: drawn, shown: this.texts.compact(drawn) })}</span>
            <span aria-hidden="true">·</span>
            <span>${this.text('page.fetched', { bytes: this.texts.bytes(session['bytesReceived']!) })}</span>
            <button
                class="quiet"
                aria-expanded=${this.countersAreOpen}
                @click=${() => this.dispatchEvent(new Event('counters'))}
            >
                ${this.text('counters')}
            </button>`;
    }
}

customElements.define('stipple-status', StatusLine);
