import { css, html, type TemplateResult } from 'lit';

import { headingOf, regionOf, withCentre, withHeading, withSize } from '../clipping/boxes.ts';
import type { Selected } from '../clipping/clipping.ts';
import { flyToViewOf, isViewOf } from '../clipping/corners.ts';
import { measuredBox } from '../clipping/measured_box.ts';
import { pointsAddress, withHeight } from '../clipping/regions.ts';
import type { ClipBox, ClipRegion, RegionFormat, RegionOf, ScreenPolygon, Vector } from '../wasm/values.ts';
import { select } from './fields.ts';
import { ModelElement } from './model_element.ts';
import { servedLink } from './served_link.ts';
import { cardStyles, controlStyles } from './shared_styles.ts';

const modes: ClipBox['mode'][] = ['hideOutside', 'hideInside', 'highlight'];
const formats = ['laz', 'las', 'ply', 'csv'];
const ownFormats: RegionFormat[] = ['laz', 'las', 'csv'];

/** Clip boxes and regions by number: mode, and of boxes centre, size, heading, of others heights; and the points inside as files. */
export class ClipList extends ModelElement {
    static override styles = [
        controlStyles,
        cardStyles,
        css`
            li {
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
                min-height: 1.8rem;
                padding: 0 0.4rem;
                font-size: 0.8rem;
            }
        `,
    ];

    protected override sources(): EventTarget[] {
        return [this.model.regionFiles];
    }

    override render(): TemplateResult {
        const { clipping } = this.model;
        return html`<ul>
            ${clipping.boxes.map((box, index) => this.renderBox(box, index))}
            ${clipping.regions.map((clip, index) => this.renderRegion(clip, index))}
        </ul>`;
    }

    private renderBox(box: ClipBox, index: number): TemplateResult {
        const { clipping } = this.model;
        const change = (next: ClipBox): void => clipping.change(index, next);
        const name = this.text('clip.box', { number: index + 1 }), heading = headingOf(box);
        return html`<li class=${clipping.isSelected({ box: index }) ? 'selected' : ''} data-box=${index}>
            ${this.renderHead(name, { box: index }, () => clipping.remove(index))}
            ${this.renderMode(box.mode, (mode) => change({ ...box, mode }))}
            ${this.renderNumbers(this.text('clip.centre'), name, box.centre, (axis, value) =>
                change(withCentre(box, box.centre.map((old, at) => (at === axis ? value : old)) as Vector)),
            )}
            ${this.renderNumbers(this.text('clip.size'), name, box.halfSize.map((half) => 2 * half), (axis, value) =>
                change(withSize(box, axis, value)),
            )}
            ${heading === undefined
                ? html`<p class="files">${this.text('clip.turned')}</p>`
                : this.renderNumbers(this.text('clip.heading'), name, [heading], (_, value) => change(withHeading(box, value)))}
            <p class="files" data-volume>
                ${this.text('clip.volume', { volume: this.volumeOf(box) })}
                <button aria-label=${this.text('clip.measureNamed', { name })} @click=${() => this.measure(box)}>
                    ${this.text('clip.measure')}
                </button>
            </p>
            ${this.renderFiles(regionOf(box), `box ${index}`, name)}
        </li>`;
    }

    private renderRegion(clip: ClipRegion, index: number): TemplateResult {
        const { clipping } = this.model, { region } = clip;
        const name = clipping.nameOfRegion(index), isSelected = clipping.isSelected({ region: index });
        return html`<li class=${isSelected ? 'selected' : ''} data-region=${index}>
            ${this.renderHead(name, { region: index }, () => clipping.removeRegion(index))}
            ${this.renderMode(clip.mode, (mode) => clipping.changeRegion(index, { ...clip, mode }))}
            <div class="numbers">
                <span>${this.text('clip.heights')}</span>
                ${([0, 1] as const).map((end) => this.renderHeight(clip, index, end, name))}
            </div>
            ${isSelected && 'prism' in region && !isViewOf(region.prism, this.model) ? this.renderWayBack(region.prism, name) : ''}
            ${this.renderFiles(region, `region ${index}`, name)}
        </li>`;
    }

    /** Where a polygon on the screen has handles. */
    private renderWayBack(prism: ScreenPolygon, name: string): TemplateResult {
        return html`<p class="files">
            ${this.text('clip.viewHint')}
            <button aria-label=${this.text('clip.toViewOf', { name })} @click=${() => flyToViewOf(prism, this.model)}>
                ${this.text('clip.toView')}
            </button>
        </p>`;
    }

    private renderHead(name: string, what: Selected, remove: () => void): TemplateResult {
        const { clipping } = this.model;
        return html`<div class="head">
            <strong>${name}</strong>
            <button
                aria-pressed=${clipping.isSelected(what)}
                aria-label=${this.text('clip.edit', { name })}
                @click=${() => clipping.select(what)}
            >
                ${this.text('clip.handles')}
            </button>
            <button aria-label=${this.text('clip.delete', { name })} @click=${remove}>✕</button>
        </div>`;
    }

    private renderMode(mode: ClipBox['mode'], change: (mode: ClipBox['mode']) => void): TemplateResult {
        return select(
            this.text('clip.mode'),
            mode,
            modes.map((known) => [known, this.text(`clip.${known}`)]),
            change,
        );
    }

    /** Empty: open. */
    private renderHeight(clip: ClipRegion, index: number, end: 0 | 1, name: string): TemplateResult {
        const value = clip.region.heights?.[end] ?? null;
        const shown = value === null ? '' : String(value);
        return html`<input
            type="number"
            step="any"
            placeholder=${this.text('clip.anyHeight')}
            aria-label=${this.text(end === 0 ? 'clip.lowest' : 'clip.highest', { name })}
            .value=${shown}
            @change=${(event: Event) => {
                const input = event.target as HTMLInputElement;
                const next = input.validity.badInput
                    ? undefined
                    : withHeight(clip, end, input.value === '' ? null : input.valueAsNumber);
                if (next) this.model.clipping.changeRegion(index, next);
                else input.value = shown; // it was not taken
            }}
        />`;
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

    /** Into the list of what was measured, with the number of points inside. */
    private measure(clip: ClipBox): void {
        try {
            const { points, box } = measuredBox(this.model, clip);
            this.model.measuring.addBox(points, box);
        } catch (error) {
            this.model.tell(error);
        }
    }
    private volumeOf({ halfSize: [x, y, z] }: ClipBox): string {
        const volume = 8 * x * y * z;
        return this.texts.decimals(volume, volume >= 1000 ? 1 : 4);
    }

    /** All points inside, whatever the picture shows of them: from the server, or, where it has no such address, read by the page. */
    private renderFiles(region: RegionOf, key: string, name: string): TemplateResult {
        const { clipping } = this.model, own = clipping.cloudsWithoutApi().map(({ id, name: cloud }) => ({ id, cloud }));
        const served = clipping.apisOfClouds().flatMap(({ cloud: id, name: cloud, api }) => {
            const links = formats.map((format) => ({ format, href: pointsAddress(api, region, format) }));
            if (links.every(({ href }) => href !== undefined)) return [{ cloud, links }];
            own.push({ id, cloud });
            return [];
        });
        return html`${served.map(
            ({ cloud, links }) => html`<p class="files">
                ${this.text('clip.inside', { cloud })}
                ${links.map(({ format, href }) => servedLink(this.model, href!, format, `${cloud}-${name}`))}
            </p>`,
        )}
        ${own.map(({ id, cloud }) => this.renderOwnFiles(id, cloud, region, `${key} ${id}`, name))}`;
    }

    private renderOwnFiles(id: number, cloud: string, region: RegionOf, key: string, name: string): TemplateResult {
        const { regionFiles } = this.model, running = regionFiles.of(key);
        const save = (format: RegionFormat): void =>
            void regionFiles.save(key, id, region, format, `${cloud.replace(/\.stipple$/, '')}-${name}`);
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
}

customElements.define('stipple-clip-list', ClipList);
