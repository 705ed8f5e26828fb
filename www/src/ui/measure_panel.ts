import { css, html, type TemplateResult } from 'lit';

import { exportFormats, type ExportFormat, type LonLats } from '../measuring/export_formats.ts';
import { kindOf, kindsOfMeasurement, type Measurement } from '../measuring/measurement.ts';
import type { Measuring } from '../measuring/measuring.ts';
import { resultLines } from '../measuring/results.ts';
import { displayUnits } from '../measuring/units.ts';
import { select } from './fields.ts';
import { download } from './download.ts';
import { ModelElement } from './model_element.ts';
import { cardStyles, controlStyles, factStyles } from './shared_styles.ts';
import { followToolbarKeys, keepToolbarStop, stopOf } from './toolbar.ts';

/** The measuring tools, and what was measured. */
export class MeasurePanel extends ModelElement {
    static override styles = [
        controlStyles,
        factStyles,
        cardStyles,
        css`
            .tools {
                display: grid;
                grid-template-columns: repeat(3, 1fr);
                gap: 0.4rem;
            }
            .tools button {
                padding: 0 0.2rem;
                font-size: 0.9rem;
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
            li {
                padding: 0.4rem 0.5rem 0.5rem 0.6rem;
            }
            li.hidden dl {
                opacity: 0.5;
            }
            .head {
                display: grid;
                grid-template-columns: 1fr auto auto auto;
                align-items: center;
            }
            .head input {
                font-size: inherit;
                font-weight: 600;
                background: none;
                border: 0;
                border-radius: 4px;
                padding: 0.1rem 0.2rem;
            }
            .head button {
                background: none;
                border-color: transparent;
                color: var(--muted);
                min-height: 1.75rem;
                padding: 0 0.35rem;
                font-size: 0.8rem;
            }
            dl {
                gap: 0.1rem 0.8rem;
                margin-top: 0.2rem;
            }
            dd small {
                color: var(--muted);
            }
            .section {
                min-height: 1.75rem;
                font-size: 0.82rem;
                margin-top: 0.2rem;
            }
            .height {
                display: grid;
                grid-template-columns: 1fr auto;
                gap: 0.4rem;
                margin-top: 0.3rem;
            }
            .error {
                margin: 0.3rem 0 0;
                font-size: 0.82rem;
                color: var(--danger);
            }
            .files {
                display: flex;
                flex-wrap: wrap;
                gap: 0.4rem;
                margin-top: 0.6rem;
            }
        `,
    ];

    protected override sources(): EventTarget[] {
        return [this.measuring];
    }

    private get measuring(): Measuring {
        return this.model.measuring;
    }

    override render(): TemplateResult {
        const { measuring } = this;
        return html`<fieldset>
            <legend>${this.text('measure')}</legend>
            <div
                class="tools"
                role="toolbar"
                aria-label=${this.text('measure')}
                @keydown=${followToolbarKeys}
                @focusin=${keepToolbarStop}
            >
                ${kindsOfMeasurement.filter(({ isMade }) => !isMade).map(
                    ({ kind }, index) =>
                        html`<button
                            tabindex=${stopOf(index)}
                            aria-pressed=${measuring.drawnKind === kind}
                            @click=${() => this.take(kind)}
                        >
                            ${this.text(`measure.${kind}`)}
                        </button>`,
                )}
            </div>
            ${this.renderHint()}
            <p class="unseen" role="status">${this.latest()}</p>
            ${measuring.items.length > 0
                ? html`${select(
                          this.text('measure.unit'),
                          measuring.unit,
                          displayUnits.map((unit) => [unit, this.text(`unit.${unit}`)]),
                          (unit) => measuring.setUnit(unit),
                      )}
                      <ul>
                          ${measuring.items.map((item) => this.renderItem(item))}
                      </ul>
                      <div class="files">
                          ${exportFormats.map(
                              ({ format, label }) =>
                                  html`<button @click=${() => this.save(format).catch((error: unknown) => this.model.tell(error))}>${label}</button>`,
                          )}
                      </div>`
                : ''}
        </fieldset>`;
    }

    /** What was measured last, for those who do not see it appear. */
    private latest(): string {
        const item = this.measuring.latest;
        if (!item?.answer) return '';
        const lines = resultLines(item, this.measuring.unit, this.texts).map(({ name, value }) => `${name} ${value}`);
        return this.text('measure.said', { name: item.name, values: this.texts.list(lines) });
    }

    private take(kind: Measurement['kind']): void {
        if (this.measuring.drawnKind === kind) this.measuring.finish();
        else this.measuring.start(kind);
        this.model.canvas.focus({ preventScroll: true });
    }

    private renderHint(): TemplateResult | string {
        const kind = this.measuring.drawnKind;
        if (!kind) return '';
        const { points } = kindOf(kind);
        return html`<p class="hint" role="status">
            ${points === undefined
                ? this.text('measure.hintOpen')
                : this.text(kind === 'angle' ? 'measure.hintAngle' : 'measure.hintPoints', { count: points })}
        </p>`;
    }

    private renderItem(item: Measurement): TemplateResult {
        const { measuring } = this;
        const lines = resultLines(item, measuring.unit, this.texts);
        return html`<li class=${item.hidden ? 'hidden' : ''} data-measurement=${item.kind}>
            <div class="head">
                <input
                    aria-label=${this.text('measure.name')}
                    .value=${item.name}
                    @change=${(event: Event) => measuring.rename(item, (event.target as HTMLInputElement).value)}
                />
                <button
                    aria-pressed=${item.hidden}
                    aria-label=${this.text('measure.hideNamed', { name: item.name })}
                    title=${this.text('measure.hide')}
                    @click=${() => measuring.setHidden(item, !item.hidden)}
                >
                    ${item.hidden ? '◌' : '●'}
                </button>
                <button
                    aria-label=${this.text('measure.copyNamed', { name: item.name })}
                    @click=${() => void this.copy(item)}
                >
                    ${this.text('measure.copy')}
                </button>
                <button
                    aria-label=${this.text('measure.deleteNamed', { name: item.name })}
                    title=${this.text('measure.delete')}
                    @click=${() => measuring.remove(item)}
                >
                    ✕
                </button>
            </div>
            ${item.kind === 'distance' && item.answer
                ? html`<button class="section" @click=${() => this.model.profile.open(item.points.map(({ position }) => position))}>
                      ${this.text('measure.profile')}
                  </button>`
                : ''}
            ${item.kind === 'volume' ? this.renderBase(item) : ''}
            ${item.share !== undefined
                ? html`<p class="hint" role="status">${this.text('measure.reading', { share: Math.round(100 * item.share) })}</p>`
                : ''}
            ${item.error ? html`<p class="error" role="alert">${item.error}</p>` : ''}
            <dl>
                ${lines.map(
                    ({ name, field, value, deviation }) =>
                        html`<dt>${name}</dt>
                            <dd data-field=${field}>
                                ${value} ${deviation ? html`<small title=${this.text('measure.deviation')}>± ${deviation}</small>` : ''}
                            </dd>`,
                )}
            </dl>
            ${item.answer?.['crosses'] === true
                ? html`<p class="error">${this.text('measure.crosses')}</p>`
                : ''}
        </li>`;
    }

    /** What a volume's heights are taken from: its rim, or a level plane at a height that is typed or picked. */
    private renderBase(item: Measurement): TemplateResult {
        const { measuring } = this, { from } = item.base ?? { from: 'rim' };
        const heights = item.points.map(({ position }) => position[2]);
        const height =
            item.base?.from === 'height'
                ? item.base.height
                : item.base?.from === 'point'
                  ? item.base.point.position[2]
                  : Math.min(...heights);
        return html`<div class="base">
            ${select(
                this.text('volume.base'),
                from === 'rim' ? 'rim' : 'plane',
                (['rim', 'plane'] as const).map((base) => [base, this.text(`volume.${base}`)]),
                (base) => measuring.setBase(item, base === 'rim' ? { from: 'rim' } : { from: 'height', height }),
            )}
            ${from === 'rim'
                ? ''
                : html`<div class="height">
                      <input
                          type="number"
                          step="any"
                          aria-label=${this.text('volume.heightOf', { name: item.name })}
                          .value=${String(height)}
                          @change=${(event: Event) =>
                              measuring.setBase(item, {
                                  from: 'height',
                                  height: (event.target as HTMLInputElement).valueAsNumber,
                              })}
                      />
                      <button
                          aria-pressed=${measuring.isPickingBaseOf(item)}
                          aria-label=${this.text('volume.pickOf', { name: item.name })}
                          @click=${() => measuring.pickBase(item)}
                      >
                          ${this.text('volume.pick')}
                      </button>
                  </div>`}
        </div>`;
    }

    private async copy(item: Measurement): Promise<void> {
        const lines = resultLines(item, this.measuring.unit, this.texts).map(
            ({ name, value, deviation }) => `${name}\t${value}${deviation ? `\t± ${deviation}` : ''}`,
        );
        try {
            await navigator.clipboard.writeText([item.name, ...lines].join('\n'));
        } catch {
            this.model.notify(this.text('measure.noCopy'));
        }
    }

    /** Longitude and latitude of every point; undefined unless all have them. */
    private async lonLatsOf(items: Measurement[]): Promise<LonLats | undefined> {
        const points = items.flatMap((item) => item.points);
        const places = await Promise.all(points.map((point) => this.model.geography.lonLat(point)));
        const lonLats = new Map(points.map((point, i) => [point, places[i]!]));
        return places.includes(null) ? undefined : lonLats;
    }

    private async save(format: ExportFormat): Promise<void> {
        const { type } = exportFormats.find((known) => known.format === format)!;
        const { items } = this.measuring, { exportText } = await import('../measuring/exports.ts'); // loaded when it is first wanted
        const lonLats = format === 'geojson' ? await this.lonLatsOf(items) : undefined;
        if (format === 'geojson' && !lonLats) this.model.notify(this.text('measure.noLonLat'));
        download(new Blob([exportText(items, format, lonLats)], { type }), `measurements.${format}`);
    }
}

customElements.define('stipple-measure', MeasurePanel);
