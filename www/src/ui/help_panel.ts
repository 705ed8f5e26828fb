import { css, html, type TemplateResult } from 'lit';

import type { Key } from '../texts/message.ts';
import { ModelElement } from './model_element.ts';
import { panelHead } from './panel_head.ts';
import { controlStyles, factStyles, headStyles } from './shared_styles.ts';

type Topic = Extract<Key, `help.${string}.what`> extends `help.${infer T}.what` ? T : never;
const topics: Topic[] = ['turn', 'move', 'zoom', 'fly', 'views', 'back', 'undo', 'walk', 'ask', 'measure', 'clip', 'escape', 'tools', 'files'];

/** What mouse, fingers and keys do. Asks to be closed by the event 'close'. */
export class HelpPanel extends ModelElement {
    static override styles = [
        controlStyles,
        headStyles,
        factStyles,
        css`
            dl {
                gap: 0.35rem 1.2rem;
                margin-top: 0.8rem;
                font-size: 0.9rem;
            }
            dt {
                font-weight: 600;
                color: inherit;
            }
            dd {
                color: var(--muted);
                text-align: start;
            }
        `,
    ];

    override firstUpdated(): void {
        this.renderRoot.querySelector('button')!.focus();
    }

    override render(): TemplateResult {
        const close = (): void => void this.dispatchEvent(new Event('close'));
        return html`${panelHead(this.text('help'), this.text('help.close'), close)}
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
