import { css, html, type TemplateResult } from 'lit';

import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** What was done with the tools, back and again. Buttons that do nothing now keep the focus. */
export class UndoButtons extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            :host {
                display: flex;
            }
            button {
                padding: 0 0.45rem;
            }
            button[aria-disabled='true'] {
                opacity: 0.4;
                cursor: default;
            }
            svg {
                display: block;
                width: 1.1rem;
                fill: none;
                stroke: currentColor;
                stroke-width: 1.6;
                stroke-linecap: round;
                stroke-linejoin: round;
            }
            .again svg {
                transform: scaleX(-1);
            }
        `,
    ];

    protected override sources(): EventTarget[] {
        const { measuring, annotations, profile, film } = this.model;
        return [measuring, annotations, profile, film];
    }

    override render(): TemplateResult {
        const history = this.model.history!, canTakeBack = this.model.tool !== undefined || history.canUndo;
        return html`${this.renderButton('undo', '', canTakeBack)} ${this.renderButton('redo', 'again', history.canRedo)}`;
    }

    private renderButton(step: 'undo' | 'redo', way: string, isPossible: boolean): TemplateResult {
        const name = this.text(step);
        return html`<button
            class="quiet ${way}"
            title=${name}
            aria-label=${name}
            aria-disabled=${!isPossible}
            @click=${() => this.model.history![step]()}
        >
            <svg viewBox="0 0 16 16"><path d="M5.5 2.5 2 6l3.5 3.5M2.5 6H10a3.8 3.8 0 0 1 0 7.6H6"></path></svg>
        </button>`;
    }
}

customElements.define('stipple-undo', UndoButtons);
