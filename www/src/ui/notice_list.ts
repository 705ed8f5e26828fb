import './problem_list.ts';

import { css, html, type TemplateResult } from 'lit';

import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** What the person is told: that the graphics are gone, what is wrong with clouds, and notices, which can be put away. */
export class NoticeList extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            :host {
                display: grid;
                gap: 8px;
            }
            .notice {
                pointer-events: auto;
                display: grid;
                grid-template-columns: 1fr auto;
                gap: 0.6rem;
                align-items: start;
                padding: 10px 8px 10px 14px;
                background: var(--danger-back);
                border: 1px solid var(--danger);
                border-radius: 10px;
                overflow-wrap: anywhere;
            }
        `,
    ];

    override render(): TemplateResult {
        const { model } = this;
        return html`${model.isContextLost
                ? html`<div class="notice" role="alert"><span>${this.text('page.contextLost')}</span></div>`
                : ''}
            <stipple-problems .model=${model}></stipple-problems>
            ${model.notices.map(
                (notice) =>
                    html`<div class="notice" role="alert">
                        <span>${notice}</span>
                        <button class="quiet" aria-label=${this.text('page.dismiss')} @click=${() => model.dismiss(notice)}>✕</button>
                    </div>`,
            )}`;
    }
}

customElements.define('stipple-notices', NoticeList);
