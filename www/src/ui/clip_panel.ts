import { css, html, type TemplateResult } from 'lit';

import type { PolygonKind } from '../clipping/polygon_tool.ts';
import { Later } from './later.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';
import { followToolbarKeys, keepToolbarStop, stopOf } from './toolbar.ts';

const polygons: PolygonKind[] = ['ground', 'screen'];

/** What makes clip boxes and polygons; those that are there are listed by clip_list.ts. */
export class ClipPanel extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            .tools {
                display: grid;
                gap: 0.4rem;
            }
            .tools button[aria-pressed='true'] {
                background: var(--accent);
                color: var(--accent-ink);
            }
            .hint {
                margin: 0.6rem 0 0;
                font-size: 0.82rem;
                color: var(--muted);
            }
        `,
    ];

    private readonly later = new Later(this);

    override render(): TemplateResult {
        const { clipping } = this.model, drawn = clipping.tool?.kind;
        return html`<fieldset>
            <legend>${this.text('clip')}</legend>
            <div
                class="tools"
                role="toolbar"
                aria-label=${this.text('clip')}
                @keydown=${followToolbarKeys}
                @focusin=${keepToolbarStop}
            >
                <button tabindex=${stopOf(0)} @click=${() => void clipping.add()}>${this.text('clip.new')}</button>
                ${polygons.map(
                    (kind, index) =>
                        html`<button
                            tabindex=${stopOf(index + 1)}
                            aria-pressed=${drawn === kind}
                            @click=${() => this.draw(kind)}
                        >
                            ${this.text(`clip.${kind}`)}
                        </button>`,
                )}
            </div>
            ${drawn
                ? html`<p class="hint" role="status">${this.text(drawn === 'ground' ? 'measure.hintOpen' : 'clip.hintScreen')}</p>`
                : ''}
            ${clipping.isInUse && this.later.has('clips', () => import('./clip_list.ts'))
                ? html`<stipple-clip-list .model=${this.model}></stipple-clip-list>`
                : ''}
        </fieldset>`;
    }

    private draw(kind: PolygonKind): void {
        this.model.clipping.draw(kind).catch((error: unknown) => this.model.tell(error));
        this.model.canvas.focus({ preventScroll: true });
    }
}

customElements.define('stipple-clip', ClipPanel);
