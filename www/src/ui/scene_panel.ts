import { css, html, type TemplateResult } from 'lit';

import { toFragment } from '../scene/share_link.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** What is set up can be kept as a file, given to others as a link, or as a picture. */
export class ScenePanel extends ModelElement {
    static override properties = { ...ModelElement.properties, link: { state: true } };
    /** The link that was made last. */
    declare link: string;

    static override styles = [
        controlStyles,
        css`
            .ways {
                display: grid;
                grid-template-columns: repeat(auto-fit, minmax(3.6rem, 1fr));
                gap: 0.4rem;
            }
            .ways button {
                padding: 0 0.2rem;
                font-size: 0.9rem;
            }
            input[type='file'] {
                display: none;
            }
            .link {
                direction: ltr;
                width: 100%;
                margin-top: 0.5rem;
                font: inherit;
                font-size: 0.82rem;
                color: inherit;
                background: var(--raised);
                border: 1px solid var(--line);
                border-radius: 6px;
                padding: 0.3rem 0.5rem;
            }
        `,
    ];

    constructor() {
        super();
        this.link = '';
    }

    override render(): TemplateResult {
        return html`<fieldset>
            <legend>${this.text('scene')}</legend>
            <div class="ways">
                <button @click=${() => this.save()}>${this.text('scene.save')}</button>
                <button @click=${() => this.renderRoot.querySelector<HTMLInputElement>('#scene')!.click()}>
                    ${this.text('scene.load')}
                </button>
                ${this.model.shareAddress === undefined
                    ? ''
                    : html`<button @click=${() => void this.share()}>${this.text('scene.link')}</button>`}
                <button aria-pressed=${this.model.isMapOpen} @click=${() => this.model.showMap(!this.model.isMapOpen)}>
                    ${this.text('map')}
                </button>
                <button @click=${() => void this.picture()}>${this.text('scene.picture')}</button>
            </div>
            <input type="file" id="scene" accept=".json,application/json" @change=${this.load} />
            ${this.link
                ? html`<input class="link" readonly aria-label=${this.text('scene.linkLabel')} .value=${this.link} @focus=${selectAll} />`
                : ''}
        </fieldset>`;
    }

    private save(): void {
        const text = `${JSON.stringify(this.model.scenes.scene(), null, 2)}\n`;
        download(new Blob([text], { type: 'application/json' }), 'scene.json');
    }

    private async load(event: Event): Promise<void> {
        const input = event.target as HTMLInputElement, file = input.files?.[0];
        input.value = '';
        if (file) await this.model.scenes.openFile(file);
    }

    private async share(): Promise<void> {
        const address = new URL(this.model.shareAddress!, document.baseURI);
        address.hash = await toFragment(JSON.stringify(this.model.scenes.scene()));
        this.link = address.href;
        try {
            await navigator.clipboard.writeText(this.link);
        } catch {
            // The field shows it.
        }
    }

    private async picture(): Promise<void> {
        try {
            download(await this.model.surface.picture(), 'picture.png');
        } catch (error) {
            this.model.tell(error);
        }
    }
}

function selectAll(event: Event): void {
    (event.target as HTMLInputElement).select();
}

function download(content: Blob, name: string): void {
    const address = URL.createObjectURL(content);
    const link = document.createElement('a');
    link.href = address;
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

customElements.define('stipple-scene', ScenePanel);
