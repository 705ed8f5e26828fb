import './annotation_panel.ts';
import './clip_panel.ts';
import './cloud_list.ts';
import './film_panel.ts';
import './look_panel.ts';
import './measure_panel.ts';
import './scene_panel.ts';

import { css, html, type TemplateResult } from 'lit';

import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** Up to this width of the viewer (CSS pixels) panels are a sheet at its foot, closed at first. */
const narrow = 600;

/** The panel of everything that can be set. Its attribute `closed` says that only its head is seen; asks for help by the event 'help'. */
export class ControlPanel extends ModelElement {
    static override properties = { ...ModelElement.properties, closed: { type: Boolean, reflect: true } };
    declare closed: boolean;

    static override styles = [
        controlStyles,
        css`
            .body {
                display: grid;
                gap: 1.3rem;
                margin-top: 1rem;
            }
            header {
                display: flex;
                align-items: center;
                justify-content: space-between;
                gap: 0.8rem;
            }
            h1 {
                margin: 0;
                font-size: 1.05rem;
                font-weight: 650;
                letter-spacing: 0.01em;
            }
            .ask {
                margin-inline-start: auto;
            }
        `,
    ];

    constructor() {
        super();
        this.closed = false;
    }
    override connectedCallback(): void {
        super.connectedCallback();
        this.closed = this.model.canvas.clientWidth <= narrow;
    }

    /** Back to the button that help was asked by. */
    focusHelp(): void {
        this.renderRoot.querySelector<HTMLElement>('.ask')!.focus();
    }

    override render(): TemplateResult {
        const { model } = this;
        return html`<header>
                <h1>Stipple</h1>
                ${model.history ? html`<stipple-undo .model=${model}></stipple-undo>` : ''}
                <button
                    class="quiet ask"
                    aria-label=${this.text('help')}
                    aria-haspopup="dialog"
                    @click=${() => this.dispatchEvent(new Event('help'))}
                >
                    ?
                </button>
                <button
                    class="quiet"
                    aria-expanded=${!this.closed}
                    aria-controls="body"
                    @click=${() => (this.closed = !this.closed)}
                >
                    ${this.text(this.closed ? 'page.controls' : 'page.hide')}
                </button>
            </header>
            <div class="body" id="body" ?hidden=${this.closed}>
                <stipple-clouds .model=${model}></stipple-clouds>
                <stipple-measure .model=${model}></stipple-measure>
                <stipple-clip .model=${model}></stipple-clip>
                <stipple-annotations .model=${model}></stipple-annotations>
                <stipple-look .model=${model}></stipple-look>
                <stipple-film .model=${model}></stipple-film>
                <stipple-scene .model=${model}></stipple-scene>
            </div>`;
    }
}

customElements.define('stipple-controls', ControlPanel);
