import { css, html, type TemplateResult } from 'lit';

import type { CloudClass, ColourMode, Style } from '../wasm/values.ts';
import { select } from './fields.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

const gradients: Style['gradient'][] = ['viridis', 'inferno', 'grey', 'turbo', 'spectral', 'terrain'];
/** Lightness rises all the way in these. */
const safeGradients = new Set<Style['gradient']>(['viridis', 'inferno', 'grey']);

/** The attribute that a mode needs; modes without one any cloud has. */
const modes: [ColourMode, string?][] = [
    ['rgb'],
    ['intensity', 'Intensity'],
    ['elevation'],
    ['classification', 'Classification'],
    ['returnNumber', 'Return Number'],
    ['numberOfReturns', 'Number of Returns'],
    ['pointSourceId', 'Point Source ID'],
    ['gpsTime', 'GPS Time'],
    ['level'],
    ['attribute'],
    ['mix'],
];

type RangeField = 'intensityRange' | 'elevationRange' | 'levelRange' | 'attributeRange';
const rangeFields: Partial<Record<ColourMode, RangeField>> = {
    intensity: 'intensityRange',
    elevation: 'elevationRange',
    level: 'levelRange',
    returnNumber: 'attributeRange',
    numberOfReturns: 'attributeRange',
    pointSourceId: 'attributeRange',
    gpsTime: 'attributeRange',
    attribute: 'attributeRange',
};

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
                width: 100%;
                height: 2rem;
                padding: 2px;
                background: var(--raised);
                border: 1px solid var(--line);
                border-radius: 6px;
            }
            .range {
                display: grid;
                grid-template-columns: 1fr 1fr;
                gap: 0.4rem;
            }
            input[type='number'],
            textarea {
                font: inherit;
                color: inherit;
                width: 100%;
                min-width: 0;
                min-height: 2rem;
                padding: 0 0.4rem;
                background: var(--raised);
                border: 1px solid var(--line);
                border-radius: 6px;
            }
            textarea {
                direction: ltr;
                min-height: 5rem;
                padding: 0.4rem;
                font:
                    0.75rem ui-monospace,
                    monospace;
                resize: vertical;
            }
            ul {
                list-style: none;
                margin: 0.35rem 0 0;
                padding: 0;
            }
            li label {
                display: grid;
                grid-template-columns: auto auto 1fr auto;
                align-items: center;
                gap: 0.5rem;
                min-height: 1.75rem;
            }
            .swatch {
                width: 0.9rem;
                height: 0.9rem;
                border-radius: 3px;
            }
            .points {
                color: var(--muted);
                font-variant-numeric: tabular-nums;
            }
        `,
    ];

    override render(): TemplateResult {
        return html`${this.renderColour()} ${this.renderClasses()} ${this.renderFilter()} ${this.renderClip()}`;
    }

    private get attributeNames(): string[] {
        return [...new Set(this.model.clouds.flatMap((cloud) => cloud.attributes ?? []))];
    }

    private renderColour(): TemplateResult {
        const { style } = this.model;
        const attributes = this.attributeNames;
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
        return safeGradients.has(gradient) ? this.text('gradient.safe', { name }) : name;
    }

    private changeMode(colourMode: ColourMode): void {
        const { style } = this.model;
        const first = style.attribute || this.attributeNames[0];
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

    /** The range along the gradient; empty: from the clouds. */
    private renderRange(): TemplateResult | '' {
        const { style } = this.model;
        const field = rangeFields[style.colourMode];
        if (!field) return '';
        const range = style[field];
        return this.renderLimits(this.text('colour.range'), range?.[0], range?.[1], (min, max) => {
            if (min === undefined && max === undefined) this.model.changeStyle({ [field]: null });
            else if (min !== undefined && max !== undefined) this.model.changeStyle({ [field]: [min, max] });
        });
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

    /** The classes of all clouds together. */
    private renderClasses(): TemplateResult | '' {
        const classes = new Map<number, CloudClass>();
        for (const cloud of this.model.clouds)
            for (const one of cloud.classes ?? []) {
                const before = classes.get(one.class);
                classes.set(one.class, { ...one, points: one.points + (before?.points ?? 0) });
            }
        if (classes.size < 2 && this.model.style.hiddenClasses.length === 0) return '';
        const hidden = new Set(this.model.style.hiddenClasses);
        const nameOf = (one: CloudClass): string => this.texts.translated('class', one.name);
        const show = (value: number, isShown: boolean): void => {
            if (isShown) hidden.delete(value);
            else hidden.add(value);
            this.model.changeStyle({ hiddenClasses: [...hidden] });
        };
        return html`<fieldset>
            <legend>${this.text('classes')}</legend>
            <ul>
                ${[...classes.values()]
                    .sort((a, b) => a.class - b.class)
                    .map(
                        (one) =>
                            html`<li>
                                <label>
                                    <input
                                        type="checkbox"
                                        aria-label=${this.text('classes.label', { number: one.class, name: nameOf(one) })}
                                        .checked=${!hidden.has(one.class)}
                                        @change=${(event: Event) =>
                                            show(one.class, (event.target as HTMLInputElement).checked)}
                                    />
                                    <span class="swatch" .style=${`background: rgb(${one.colour.join(',')})`}></span>
                                    <span>${one.class} ${nameOf(one)}</span>
                                    <span class="points">${this.texts.compact(one.points)}</span>
                                </label>
                            </li>`,
                    )}
            </ul>
        </fieldset>`;
    }

    /** One filter; more of them come by JSON. */
    private renderFilter(): TemplateResult | '' {
        const attributes = this.attributeNames;
        if (attributes.length === 0) return '';
        const [filter] = this.model.style.filters;
        const change = (attribute: string, min?: number | null, max?: number | null): void =>
            this.model.changeStyle({
                filters: attribute === '' ? [] : [{ attribute, min: min ?? null, max: max ?? null }],
            });
        return html`<fieldset>
            <legend>${this.text('filter')}</legend>
            ${select(
                this.text('filter.by'),
                filter?.attribute ?? '',
                [['', this.text('filter.all')], ...attributes.map((name): [string, string] => [name, name])],
                (attribute) => change(attribute),
            )}
            ${filter
                ? this.renderLimits(
                      this.text('filter.fromTo'),
                      filter.min ?? undefined,
                      filter.max ?? undefined,
                      (min, max) => change(filter.attribute, min, max),
                  )
                : ''}
        </fieldset>`;
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
