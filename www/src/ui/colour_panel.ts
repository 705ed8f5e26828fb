import './class_list.ts';
import './histogram.ts';

import { css, html, type TemplateResult } from 'lit';

import { attributeOfMode, attributeRequest, colourRequest, rangeFields } from '../looks/ranges.ts';
import type { AttributeFilter, ColourMode, Style } from '../wasm/values.ts';
import { checkbox, select } from './fields.ts';
import type { RangeChange } from './histogram.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

const gradients: Style['gradient'][] = ['viridis', 'inferno', 'grey', 'turbo', 'spectral', 'terrain'];

/** The attribute that a mode needs; modes without one any cloud has. */
const modes: [ColourMode, string?][] = [
    ['rgb', 'Red'],
    ['intensity', 'Intensity'],
    ['elevation'],
    ['classification', 'Classification'],
    ['returnNumber', 'Return Number'],
    ['numberOfReturns', 'Number of Returns'],
    ['pointSourceId', 'Point Source ID'],
    ['gpsTime', 'GPS Time'],
    ['level'],
    ['attribute'],
    ['mix', 'Intensity'],
];

const mostFilters = 64;

/** What colours the points, and which of them are shown. */
export class ColourPanel extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            :host {
                display: grid;
                gap: 1.3rem;
            }
            .colour {
                height: 2rem;
                padding: 2px;
            }
            .range {
                display: grid;
                grid-template-columns: 1fr 1fr;
                gap: 0.4rem;
            }
            input[type='number'] {
                min-height: 2rem;
            }
            textarea {
                direction: ltr;
                min-height: 5rem;
                font:
                    0.75rem ui-monospace,
                    monospace;
                resize: vertical;
            }
        `,
    ];

    override render(): TemplateResult {
        return html`${this.renderColour()} ${this.renderClasses()} ${this.renderFilters()} ${this.renderClip()}`;
    }

    private renderColour(): TemplateResult {
        const { style } = this.model;
        const attributes = this.model.looks.attributeNames();
        const offered = modes.filter(
            ([mode, needed]) => mode === style.colourMode || needed === undefined || attributes.includes(needed),
        );
        return html`<fieldset>
            <legend>${this.text('colour')}</legend>
            ${select(
                this.text('colour.by'),
                style.colourMode,
                offered.map(([mode]): [ColourMode, string] => [mode, this.text(`colour.${mode}`)]),
                (colourMode) => this.changeMode(colourMode),
            )}
            ${style.colourMode === 'attribute'
                ? select(
                      this.text('colour.attributeName'),
                      style.attribute,
                      attributes.map((name): [string, string] => [name, name]),
                      (attribute) => this.model.changeStyle({ attribute, attributeRange: null }),
                  )
                : ''}
            ${style.colourMode === 'rgb' || style.colourMode === 'classification'
                ? ''
                : select(
                      this.text('colour.gradient'),
                      style.gradient,
                      gradients.map((gradient) => [gradient, this.nameOf(gradient)]),
                      (gradient) => this.model.changeStyle({ gradient }),
                  )}
            ${this.renderRange()}
            ${rangeFields[style.colourMode] || style.colourMode === 'classification'
                ? checkbox(this.text('colour.legend'), this.model.looks.showsLegend, (isShown) =>
                      this.model.looks.showLegend(isShown),
                  )
                : ''}
            <label class="row">
                <span>${this.text('colour.background')}</span>
                <input
                    class="colour"
                    type="color"
                    .value=${hexOf(style.background)}
                    @input=${(event: Event) =>
                        this.model.changeStyle({
                            background: bytesOf((event.target as HTMLInputElement).value),
                        })}
                />
            </label>
        </fieldset>`;
    }

    private nameOf(gradient: Style['gradient']): string {
        const name = this.text(`gradient.${gradient}`);
        return this.model.looks.gradients[gradient].isColourBlindSafe ? this.text('gradient.safe', { name }) : name;
    }

    private changeMode(colourMode: ColourMode): void {
        const { style } = this.model;
        const first = style.attribute || this.model.looks.attributeNames()[0];
        if (colourMode === 'attribute' && first === undefined) return;
        this.model.changeStyle({
            colourMode,
            attributeRange: null, // of another attribute
            ...(colourMode === 'attribute' ? { attribute: first } : {}),
            ...(colourMode === 'mix' && style.mix.length === 0
                ? { mix: [{ colourMode: 'rgb' }, { colourMode: 'intensity' }] }
                : {}),
        });
    }

    /** The range along the gradient; without one from the clouds, or from what is in view. */
    private renderRange(): TemplateResult | '' {
        const { model } = this, { style, looks } = model;
        const field = rangeFields[style.colourMode];
        if (!field) return '';
        const range = style[field], isCounted = colourRequest(style) !== undefined;
        return html`${isCounted ? this.renderColourHistogram() : ''}
            ${this.renderLimits(this.text('colour.range'), range?.[0], range?.[1], (min, max) => {
                if (min === undefined && max === undefined) looks.setRange(null);
                else if (min !== undefined && max !== undefined) looks.setRange([min, max]);
            })}
            ${isCounted
                ? checkbox(this.text('colour.ofView'), looks.followsView, (follows) => looks.followView(follows))
                : ''}`;
    }

    private renderColourHistogram(): TemplateResult {
        const { model } = this, { style, looks } = model, field = rangeFields[style.colourMode]!;
        return html`<stipple-histogram
            .model=${model}
            .label=${this.text('colour.handles')}
            .request=${colourRequest(style)}
            .range=${style[field]}
            .automatic=${looks.drawnStyle()[field] ?? undefined}
            .colours=${looks.gradients[style.gradient].colours}
            .isWhole=${looks.isWhole(attributeOfMode(style) ?? '')}
            @range=${({ detail }: RangeChange) => looks.setRange(detail)}
        ></stipple-histogram>`;
    }

    private renderLimits(
        label: string,
        min: number | undefined,
        max: number | undefined,
        change: (min: number | undefined, max: number | undefined) => void,
    ): TemplateResult {
        const input = (name: string, value: number | undefined): TemplateResult =>
            html`<input
                type="number"
                step="any"
                aria-label=${this.text('colour.fieldOf', { label, field: name })}
                placeholder=${name}
                .value=${value === undefined ? '' : String(value)}
                @change=${(event: Event) => {
                    const inputs = (event.target as HTMLElement).parentElement!.querySelectorAll('input');
                    const read = (at: 0 | 1): number | undefined =>
                        inputs[at]!.value === '' ? undefined : Number(inputs[at]!.value);
                    change(read(0), read(1));
                }}
            />`;
        return html`<div class="row">
            <span>${label}</span>
            <div class="range">${input(this.text('colour.least'), min)}${input(this.text('colour.greatest'), max)}</div>
        </div>`;
    }

    private renderClasses(): TemplateResult | '' {
        const { model } = this;
        const hasSome = model.looks.classes().length > 1 || model.style.hiddenClasses.length > 0;
        return hasSome ? html`<stipple-classes .model=${model}></stipple-classes>` : '';
    }

    /** Ranges that hide what lies outside of them, and one more to choose. */
    private renderFilters(): TemplateResult | '' {
        const attributes = this.model.looks.attributeNames();
        if (attributes.length === 0) return '';
        const { filters } = this.model.style;
        return html`<fieldset>
            <legend>${this.text('filter')}</legend>
            ${filters.map((filter, at) => this.renderFilter(filter, at, attributes))}
            ${filters.length < mostFilters ? this.renderFilterChoice(filters.length, undefined, attributes) : ''}
        </fieldset>`;
    }

    private renderFilterChoice(at: number, filter: AttributeFilter | undefined, attributes: string[]): TemplateResult {
        return select(
            at === 0 ? this.text('filter.by') : this.text('filter.and'),
            filter?.attribute ?? '',
            [['', at === 0 ? this.text('filter.all') : '…'], ...attributes.map((name): [string, string] => [name, name])],
            (attribute) => this.changeFilter(at, attribute === '' ? undefined : { attribute, min: null, max: null }),
        );
    }

    private renderFilter(filter: AttributeFilter, at: number, attributes: string[]): TemplateResult {
        const { attribute, min, max } = filter;
        const change = (least?: number, most?: number): void =>
            this.changeFilter(at, { attribute, min: least ?? null, max: most ?? null });
        return html`${this.renderFilterChoice(at, filter, attributes)}
            <stipple-histogram
                .model=${this.model}
                .label=${this.text('filter.shown', { attribute })}
                .request=${attributeRequest(attribute)}
                .range=${min === null && max === null ? null : [min, max]}
                .isWhole=${this.model.looks.isWhole(attribute)}
                @range=${({ detail }: RangeChange) => change(detail?.[0], detail?.[1])}
            ></stipple-histogram>
            ${this.renderLimits(
                at === 0 ? this.text('filter.fromTo') : this.text('filter.fromToNumbered', { number: at + 1 }),
                min ?? undefined,
                max ?? undefined,
                change,
            )}`;
    }

    /** Undefined takes the filter away. */
    private changeFilter(at: number, filter: AttributeFilter | undefined): void {
        const filters = [...this.model.style.filters];
        filters.splice(at, 1, ...(filter ? [filter] : []));
        this.model.changeStyle({ filters });
    }

    private renderClip(): TemplateResult {
        const { clipBoxes } = this.model.style;
        return html`<fieldset>
            <legend>${this.text('clip.json')}</legend>
            <textarea
                aria-label=${this.text('clip.jsonLabel')}
                spellcheck="false"
                placeholder='[{"mode": "hideOutside", "centre": [0, 0, 0], "halfSize": [1, 1, 1]}]'
                .value=${clipBoxes.length > 0 ? JSON.stringify(clipBoxes) : ''}
                @change=${(event: Event) => this.changeClip((event.target as HTMLTextAreaElement).value)}
            ></textarea>
        </fieldset>`;
    }

    private changeClip(text: string): void {
        try {
            this.model.changeStyle({ clipBoxes: text.trim() === '' ? [] : JSON.parse(text) });
        } catch (error) {
            this.model.notify(this.text('clip.jsonWrong', { reason: this.texts.sentenceOf(error) }));
        }
    }
}

function hexOf(bytes: [number, number, number]): string {
    return `#${bytes.map((byte) => byte.toString(16).padStart(2, '0')).join('')}`;
}
function bytesOf(hex: string): [number, number, number] {
    const value = Number.parseInt(hex.slice(1), 16);
    return [(value >> 16) & 255, (value >> 8) & 255, value & 255];
}

customElements.define('stipple-colour', ColourPanel);
