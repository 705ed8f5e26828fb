import { css, html, type TemplateResult } from 'lit';

import { headingOf, pointsAddress, regionOf, withCentre, withHeading, withSize } from '../clipping/boxes.ts';
import type { ClipBox, RegionFormat, Vector } from '../wasm/values.ts';
import { select } from './fields.ts';
import { ModelElement } from './model_element.ts';
import { servedLink } from './served_link.ts';
import { controlStyles } from './shared_styles.ts';

const modes: ClipBox['mode'][] = ['hideOutside', 'hideInside', 'highlight'];
const formats = ['laz', 'las', 'ply', 'csv'];
const ownFormats: RegionFormat[] = ['laz', 'las', 'csv'];

/** Clip boxes by number: mode, centre, size, heading; and the points inside as files. */
export class ClipPanel extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            ul {
                list-style: none;
                margin: 0.6rem 0 0;
                padding: 0;
                display: grid;
                gap: 0.6rem;
            }
            li {
                border: 1px solid var(--line);
                border-radius: 8px;
                padding: 0.4rem 0.6rem 0.6rem;
            }
            li.selected {
                border-color: var(--accent);
            }
            .head {
                display: grid;
                grid-template-columns: 1fr auto auto;
                align-items: center;
                gap: 0.4rem;
            }
            .numbers {
                display: grid;
                grid-template-columns: 3.4rem repeat(3, 1fr);
                align-items: center;
                gap: 0.3rem;
                margin-top: 0.4rem;
                font-size: 0.78rem;
            }
            .numbers input::-webkit-inner-spin-button {
                appearance: none;
            }
            .numbers input {
                font-size: inherit;
                padding: 0.2rem 0.3rem;
            }
            .files {
                margin: 0.5rem 0 0;
                font-size: 0.82rem;
                color: var(--muted);
            }
            .files a {
                color: var(--accent);
                margin-inline-start: 0.4rem;
            }
            .files button {
                min-height: 1.5rem;
                padding: 0 0.4rem;
                font-size: 0.8rem;
            }
            .add {
                width: 100%;
            }
        `,
    ];

    protected override sources(): EventTarget[] {
        return [this.model.regionFiles];
    }

    override render(): TemplateResult {
        const { clipping } = this.model;
        return html`<fieldset>
            <legend>${this.text('clip')}</legend>
            <button class="add" @click=${() => void clipping.add()}>${this.text('clip.new')}</button>
            <ul>
                ${clipping.boxes.map((box, index) => this.renderBox(box, index))}
            </ul>
        </fieldset>`;
    }

    private renderBox(box: ClipBox, index: number): TemplateResult {
        const { clipping } = this.model;
        const change = (next: ClipBox): void => clipping.change(index, next);
        const name = this.text('clip.box', { number: index + 1 }), heading = headingOf(box);
        return html`<li class=${clipping.selected === index ? 'selected' : ''} data-box=${index}>
            <div class="head">
                <strong>${name}</strong>
                <button
                    aria-pressed=${clipping.selected === index}
                    aria-label=${this.text('clip.edit', { name })}
                    @click=${() => clipping.select(index)}
                >
                    ${this.text('clip.handles')}
                </button>
                <button aria-label=${this.text('clip.delete', { name })} @click=${() => clipping.remove(index)}>✕</button>
            </div>
            ${select(
                this.text('clip.mode'),
                box.mode,
                modes.map((mode) => [mode, this.text(`clip.${mode}`)]),
                (mode) => change({ ...box, mode }),
            )}
            ${this.renderNumbers(this.text('clip.centre'), name, box.centre, (axis, value) =>
                change(withCentre(box, box.centre.map((old, at) => (at === axis ? value : old)) as Vector)),
            )}
            ${this.renderNumbers(this.text('clip.size'), name, box.halfSize.map((half) => 2 * half), (axis, value) =>
                change(withSize(box, axis, value)),
            )}
            ${heading === undefined
                ? html`<p class="files">${this.text('clip.turned')}</p>`
                : this.renderNumbers(this.text('clip.heading'), name, [heading], (_, value) => change(withHeading(box, value)))}
            <p class="files" data-volume>${this.text('clip.volume', { volume: this.volumeOf(box) })}</p>
            ${clipping.apisOfClouds().map(({ name: cloud, api }) => this.renderFiles(cloud, api, box))}
            ${clipping.cloudsWithoutApi().map(({ id, name: cloud }) => this.renderOwnFiles(id, cloud, box, index))}
        </li>`;
    }

    private renderNumbers(
        label: string,
        of: string,
        values: number[],
        change: (axis: number, value: number) => void,
    ): TemplateResult {
        return html`<div class="numbers">
            <span>${label}</span>
            ${values.map(
                (value, axis) =>
                    html`<input
                        type="number"
                        step="any"
                        title=${String(value)}
                        aria-label=${values.length > 1
                            ? this.text('clip.axisOf', { label, axis: 'xyz'[axis]!, name: of })
                            : this.text('clip.fieldOf', { label, name: of })}
                        .value=${String(Number(value.toPrecision(12)))}
                        @change=${(event: Event) => {
                            const input = event.target as HTMLInputElement, number = input.valueAsNumber;
                            if (Number.isFinite(number)) change(axis, number);
                            input.value = String(Number(value.toPrecision(12))); // shown anew if it was not taken
                            this.requestUpdate();
                        }}
                    />`,
            )}
        </div>`;
    }

    private volumeOf({ halfSize: [x, y, z] }: ClipBox): string {
        const volume = 8 * x * y * z;
        return this.texts.decimals(volume, volume >= 1000 ? 1 : 4);
    }

    /** The same of a cloud that no server cuts: the page reads the points itself. */
    private renderOwnFiles(id: number, cloud: string, box: ClipBox, index: number): TemplateResult {
        const { regionFiles } = this.model, key = `clip ${index} ${id}`, running = regionFiles.of(key);
        const save = (format: RegionFormat): void =>
            void regionFiles.save(key, id, regionOf(box), format, `${cloud.replace(/\.stipple$/, '')}-${index + 1}`);
        return html`<p class="files" data-own=${id}>
            ${this.text('clip.inside', { cloud })}
            ${running
                ? html`<span role="status"
                          >${this.text('region.making', {
                              format: running.format.toUpperCase(),
                              share: Math.round(100 * running.share),
                              points: running.points,
                          })}</span
                      >
                      <button @click=${() => running.cancel()}>${this.text('region.cancel')}</button>`
                : ownFormats.map(
                      (format) => html`<button @click=${() => save(format)}>${format.toUpperCase()}</button>`,
                  )}
        </p>`;
    }

    /** All points inside, whatever the picture shows of them. */
    private renderFiles(cloud: string, api: string, box: ClipBox): TemplateResult | string {
        const links = formats.flatMap((format) => {
            const address = pointsAddress(api, box, format);
            return address === undefined ? [] : servedLink(this.model, address, format, cloud);
        });
        return links.length > 0 ? html`<p class="files">${this.text('clip.inside', { cloud })} ${links}</p>` : '';
    }
}

customElements.define('stipple-clip', ClipPanel);
