import { css, html, type TemplateResult } from 'lit';

import { ModelElement } from './model_element.ts';

/** How much of what the picture wants is drawn; gone when all is. */
export class LoadingBar extends ModelElement {
    static override styles = css`
        :host {
            display: contents;
        }
        progress {
            appearance: none;
            position: absolute;
            inset: 0 0 auto 0;
            width: 100%;
            height: 3px;
            border: 0;
            background: none;
        }
        progress::-webkit-progress-bar {
            background: none;
        }
        progress::-webkit-progress-value {
            background: var(--accent);
            transition: width 150ms;
        }
        progress::-moz-progress-bar {
            background: var(--accent);
        }
        @media (prefers-reduced-motion: reduce) {
            progress::-webkit-progress-value {
                transition: none;
            }
        }
    `;

    override render(): TemplateResult | string {
        const { frame, settled } = this.model.counters;
        if (settled) return '';
        return html`<progress
            aria-label=${this.text('page.loading')}
            max=${Math.max(1, Number(frame['nodesSelected']))}
            .value=${Number(frame['nodesDrawn'])}
        ></progress>`;
    }
}

customElements.define('stipple-loading', LoadingBar);
