import { css, html, type TemplateResult } from 'lit';

import type { CloudState } from '../wasm/values.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** The clouds that are open, those that the server offers besides, and the ways to open more. */
export class CloudList extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            ul {
                list-style: none;
                margin: 0;
                padding: 0;
                display: grid;
                gap: 0.4rem;
            }
            li {
                display: grid;
                grid-template-columns: auto 1fr auto;
                align-items: center;
                gap: 0.6rem;
                padding: 0.45rem 0.45rem 0.45rem 0.6rem;
                background: var(--raised);
                border-radius: 8px;
            }
            li.failed {
                background: var(--danger-back);
            }
            .offer {
                display: grid;
                grid-template-columns: 1fr auto;
                width: 100%;
                text-align: start;
                align-items: center;
                padding: 0.5rem 0.6rem;
                border-style: dashed;
                background: none;
                border-radius: 8px;
            }
            .name {
                overflow-wrap: anywhere;
            }
            button.name {
                display: block;
                width: 100%;
                min-height: 24px;
                padding: 0;
                border: 0;
                background: none;
                text-align: start;
            }
            button.name:hover {
                text-decoration: underline;
            }
            small {
                display: block;
                color: var(--muted);
            }
            .failed small,
            small.interrupted {
                color: var(--danger);
                overflow-wrap: anywhere;
            }
            .close {
                width: 1.8rem;
                min-height: 1.8rem;
                padding: 0;
                background: none;
                border-color: transparent;
                color: var(--muted);
            }
            .open {
                width: 100%;
                margin-top: 0.5rem;
            }
            p {
                margin: 0.2rem 0 0;
                color: var(--muted);
            }
            input[type='file'] {
                display: none;
            }
        `,
    ];

    override render(): TemplateResult {
        const { clouds, listing } = this.model;
        const offers = listing.clouds.filter((cloud) => !this.model.opened.has(cloud.address));
        return html`<h2>${this.text('clouds')}</h2>
            <ul>
                ${clouds.map((cloud) => this.renderCloud(cloud))}
                ${offers.map(
                    (cloud) =>
                        html`<button
                            class="offer"
                            @click=${() => this.model.opened.openAddress(cloud.address, cloud.name)}
                        >
                            <span class="name">${cloud.name}</span>
                            <small>${this.points(cloud.pointCount, this.texts.compact(cloud.pointCount))}</small>
                        </button>`,
                )}
            </ul>
            ${listing.goesOn ? html`<button class="open" @click=${() => listing.more()}>${this.text('clouds.more')}</button>` : ''}
            ${offers.length < 2
                ? ''
                : html`<button class="open" @click=${() => listing.openAll()}>${this.text('clouds.openAll')}</button>`}
            ${clouds.length + offers.length === 0
                ? html`<p>${listing.error || this.text('clouds.none')}</p>`
                : ''}
            <input type="file" id="file" accept=".stipple" multiple @change=${this.pick} />
            <button class="open" @click=${() => this.renderRoot.querySelector<HTMLInputElement>('#file')!.click()}>
                ${this.text('clouds.openFile')}
            </button>`;
    }

    private renderCloud(cloud: CloudState): TemplateResult {
        return html`<li class=${cloud.stage}>
            <input
                type="checkbox"
                aria-label=${this.text('clouds.show', { name: cloud.name })}
                .checked=${cloud.visible}
                ?disabled=${cloud.stage === 'failed'}
                @change=${(event: Event) =>
                    this.model.opened.setVisible(cloud.id, (event.target as HTMLInputElement).checked)}
            />
            <div>
                <button class="name" title=${this.text('clouds.showAll')} @click=${() => void this.model.camera.flyToCloud(cloud.id)}>
                    ${cloud.name}
                </button>
                ${cloud.stage === 'failed'
                    ? html`<small>${this.texts.said(cloud.error?.said ?? '')}</small>`
                    : html`<small title=${cloud.crs ?? ''}>${this.describe(cloud)}</small>`}
                ${cloud.interrupted ? html`<small class="interrupted">${this.texts.said(cloud.interrupted.said)}</small>` : ''}
                ${cloud.caution ? html`<small class="caution">${this.text('clouds.note', { note: this.texts.said(cloud.caution) })}</small>` : ''}
            </div>
            <button class="close" aria-label=${this.text('clouds.close', { name: cloud.name })} @click=${() => this.model.opened.close(cloud.id)}>
                ✕
            </button>
        </li>`;
    }

    private describe(cloud: CloudState): string {
        if (cloud.stage === 'opening' || cloud.stage === 'waiting') return this.text(`clouds.${cloud.stage}`);
        const count = cloud.pointCount ?? 0;
        return `${this.points(count, this.texts.count(count))}${cloud.crs ? ` · ${cloud.crs}` : ''}`;
    }
    private points(count: number, shown: string): string {
        return this.text('page.points', { count, shown });
    }

    private pick(event: Event): void {
        const input = event.target as HTMLInputElement;
        for (const file of input.files ?? []) this.model.opened.openFile(file);
        input.value = '';
    }
}

customElements.define('stipple-clouds', CloudList);
