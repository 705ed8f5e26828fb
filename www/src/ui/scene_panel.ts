import { css, html, type TemplateResult } from 'lit';

import { toFragment } from '../scene/share_link.ts';
import { download } from './download.ts';
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
            .size {
                display: grid;
                grid-template-columns: 1fr auto 1fr;
                align-items: center;
                gap: 0.3rem;
            }
            .link {
                direction: ltr;
                margin-top: 0.5rem;
            }
        `,
    ];

    constructor() {
        super();
        this.link = '';
    }

    override render(): TemplateResult {
        const { making } = this.model;
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
                ${making
                    ? html`<button @click=${() => making.cancel()}>${this.text('picture.giveUp', { share: Math.floor(100 * making.share) })}</button>`
                    : html`<button @click=${() => void this.picture()}>${this.text('scene.picture')}</button>`}
            </div>
            ${this.renderSize()}
            <input type="file" id="scene" accept=".json,application/json" @change=${this.load} />
            ${this.link
                ? html`<input class="link" readonly aria-label=${this.text('scene.linkLabel')} .value=${this.link} @focus=${selectAll} />`
                : ''}
        </fieldset>`;
    }

    /** Of pictures that are written; without one that of the picture on the page. */
    private renderSize(): TemplateResult {
        const { model } = this, { canvas } = model;
        const field = (label: string, value: number | undefined, shown: number, change: (value: number | undefined) => void): TemplateResult =>
            html`<input
                type="number"
                min="1"
                max="65000"
                aria-label=${label}
                placeholder=${String(shown)}
                .value=${value === undefined ? '' : String(value)}
                @change=${(event: Event) => {
                    const { value: text } = event.target as HTMLInputElement;
                    change(text === '' ? undefined : Number(text));
                }}
            />`;
        return html`<div class="row">
            <span>${this.text('picture.sizeLabel')}</span>
            <div class="size">
                ${field(this.text('picture.width'), model.wantedSize.width, canvas.width, (width) => model.wantPicture({ ...model.wantedSize, width }))}
                ×
                ${field(this.text('picture.height'), model.wantedSize.height, canvas.height, (height) => model.wantPicture({ ...model.wantedSize, height }))}
            </div>
        </div>`;
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
            await (await import('../pictures/pictures.ts')).savePicture(this.model);
        } catch (error) {
            this.model.tell(error);
        }
    }
}

function selectAll(event: Event): void {
    (event.target as HTMLInputElement).select();
}

customElements.define('stipple-scene', ScenePanel);
