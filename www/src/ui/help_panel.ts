import { css, html, type TemplateResult } from 'lit';

import type { Key } from '../texts/message.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

type Topic = Extract<Key, `help.${string}.what`> extends `help.${infer T}.what` ? T : never;
const topics: Topic[] = ['turn', 'move', 'zoom', 'fly', 'views', 'back', 'walk', 'ask', 'measure', 'escape', 'tools', 'files'];

/** What mouse, fingers and keys do. Asks to be closed by the event 'close'. */
export class HelpPanel extends ModelElement {
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
                gap: 0.35rem 1.2rem;
                margin: 0.8rem 0 0;
                font-size: 0.9rem;
            }
            dt {
                font-weight: 600;
            }
            dd {
                margin: 0;
                color: var(--muted);
                overflow-wrap: anywhere;
            }
        `,
    ];

    override firstUpdated(): void {
        this.renderRoot.querySelector('button')!.focus();
    }

    override render(): TemplateResult {
        return html`<header>
                <h2>${this.text('help')}</h2>
                <button aria-label=${this.text('help.close')} @click=${() => this.dispatchEvent(new Event('close'))}>✕</button>
            </header>
            <dl>
                ${topics.map(
                    (topic) =>
                        html`<dt>${this.text(`help.${topic}.what`)}</dt>
                            <dd>${this.text(`help.${topic}.how`)}</dd>`,
                )}
            </dl>`;
    }
}

customElements.define('stipple-help', HelpPanel);
