import { css, html, nothing, svg, type TemplateResult } from 'lit';

import { roundInSpan, type Range } from '../looks/ranges.ts';
import type { Histogram, HistogramRequest, Vector } from '../wasm/values.ts';
import { Counted } from './counted.ts';
import { followPointer } from './follow_pointer.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** Told as 'range' when a person moves a handle; null: back to what holds without one. */
export type RangeChange = CustomEvent<Range | null>;

const barHeight = 44;

/**
 * How often values occur among the points in view, with two handles for a range: dragged, or moved by arrow keys (with
 * shift ten steps, Page Up and Down, Home and End); Delete takes the range back. Counts only while it is seen.
 */
export class HistogramElement extends ModelElement {
    static override properties = {
        ...ModelElement.properties,
        label: { attribute: false },
        request: { attribute: false },
        range: { attribute: false },
        automatic: { attribute: false },
        colours: { attribute: false },
        isWhole: { attribute: false },
    };
    declare label: string;
    declare request: HistogramRequest;
    /** Null: none was set. */
    declare range: [number | null, number | null] | null;
    /** Where the handles are then; absent: at the ends. */
    declare automatic: Range | undefined;
    /** Of a gradient along the range. */
    declare colours: Vector[] | undefined;
    /** Values are whole numbers. */
    declare isWhole: boolean;

    static override styles = [
        controlStyles,
        css`
            :host {
                display: block;
                margin-top: 0.5rem;
            }
            .field {
                position: relative;
                height: 72px;
                touch-action: none;
                user-select: none;
            }
            svg {
                position: absolute;
                inset: 0 0 auto 0;
                width: 100%;
                height: 44px;
                overflow: visible;
            }
            rect {
                fill: var(--muted);
            }
            rect.outside {
                opacity: 0.35;
            }
            .strip {
                position: absolute;
                top: 46px;
                height: 8px;
                border-radius: 2px;
                background: var(--accent);
            }
            .handle {
                position: absolute;
                top: 0;
                width: 26px;
                height: 60px;
                margin-inline-start: -13px;
                cursor: ew-resize;
                border-radius: 6px;
            }
            .handle::before {
                content: '';
                position: absolute;
                left: 12px;
                width: 2px;
                top: 0;
                bottom: 6px;
                background: var(--text);
            }
            .handle::after {
                content: '';
                position: absolute;
                left: 6px;
                bottom: 0;
                width: 14px;
                height: 14px;
                border-radius: 50%;
                background: var(--text);
                border: 2px solid var(--panel-solid);
                box-sizing: border-box;
            }
            .ends {
                position: absolute;
                inset: auto 0 0 0;
                display: flex;
                justify-content: space-between;
                font-size: 0.72rem;
                line-height: 1;
                color: var(--muted);
                font-variant-numeric: tabular-nums;
            }
            .note {
                font-size: 0.72rem;
                color: var(--muted);
                margin: 0.2rem 0 0;
            }
        `,
    ];

    private readonly counted = new Counted(this, () => this.request);

    private get histogram(): Histogram | undefined {
        return this.counted.histogram;
    }

    /** Where the handles are. */
    private get ends(): Range {
        const [least, most] = this.seenRange;
        const [from, to] = this.automatic ?? [least, most];
        return [this.range?.[0] ?? from, this.range?.[1] ?? to];
    }
    /** What the points in view have. */
    private get seenRange(): Range {
        const histogram = this.histogram;
        return histogram && histogram.points > 0 ? [histogram.min, histogram.max] : [0, 1];
    }
    /** What the field spans: all values in view, and both handles. */
    private get domain(): Range {
        const [a, b] = this.range || this.automatic ? this.ends : this.seenRange;
        const [from, to] = this.histogram?.range ?? [a, b];
        const low = Math.min(from, a), high = Math.max(to, b);
        return high > low ? [low, high] : [low - 0.5, high + 0.5];
    }

    override render(): TemplateResult {
        const domain = this.domain, [from, to] = this.ends, histogram = this.histogram;
        const span = domain[1] - domain[0];
        // Bins of whole numbers reach half a one beyond them.
        const [least, most] = this.isWhole ? [Math.ceil(domain[0]), Math.floor(domain[1])] : domain;
        const percent = (value: number): number => (100 * (value - domain[0])) / span;
        const end = (value: number): string => this.texts.number(roundInSpan(value, span));
        return html`<div class="field" data-histogram=${this.label} data-points=${histogram?.points ?? nothing}>
                <svg viewBox="0 0 1000 44" preserveAspectRatio="none" aria-hidden="true">
                    ${histogram ? this.renderBars(histogram, domain) : ''}
                </svg>
                <div
                    class="strip"
                    .style=${`left: ${percent(from)}%; width: ${Math.max(0, percent(to) - percent(from))}%; ${this.background}`}
                ></div>
                ${this.renderHandle(0, percent(from), end(from))} ${this.renderHandle(1, percent(to), end(to))}
                <div class="ends" aria-hidden="true"><span>${end(least)}</span><span>${end(most)}</span></div>
            </div>
            ${histogram && histogram.points === 0 ? html`<p class="note">${this.text('histogram.none')}</p>` : ''}`;
    }

    private get background(): string {
        if (!this.colours) return '';
        return `background: linear-gradient(to right, ${this.colours.map((colour) => `rgb(${colour.join(' ')})`).join(', ')})`;
    }

    /** One bar a bin; heights are linear. */
    private renderBars({ bins, range }: Histogram, domain: Range): TemplateResult[] {
        if (!range) return [];
        const most = Math.max(1, ...bins), [from, to] = this.ends;
        const end = (value: number): string => this.texts.number(roundInSpan(value, width));
        const width = (range[1] - range[0]) / bins.length, scale = 1000 / (domain[1] - domain[0]);
        return bins.map((count, i) => {
            const start = range[0] + i * width, height = (barHeight * count) / most;
            const isOutside = start + width <= from || start > to;
            return svg`<rect
                class=${isOutside ? 'outside' : ''}
                x=${(start - domain[0]) * scale}
                y=${barHeight - height}
                width=${width * scale}
                height=${height}
                data-count=${count}
            ><title>${this.text('histogram.bar', { from: end(start), to: end(start + width), count })}</title></rect>` as unknown as TemplateResult;
        });
    }

    private renderHandle(which: 0 | 1, percent: number, text: string): TemplateResult {
        const [low, high] = this.domain, ends = this.ends;
        return html`<div
            class="handle"
            role="slider"
            tabindex="0"
            aria-label=${this.text('colour.fieldOf', { label: this.label, field: this.text(which === 0 ? 'colour.least' : 'colour.greatest') })}
            aria-valuemin=${which === 0 ? low : ends[0]}
            aria-valuemax=${which === 0 ? ends[1] : high}
            aria-valuenow=${ends[which]}
            aria-valuetext=${text}
            .style=${`left: ${Math.min(100, Math.max(0, percent))}%`}
            @pointerdown=${(event: PointerEvent) => this.drag(event, which)}
            @keydown=${(event: KeyboardEvent) => this.key(event, which)}
        ></div>`;
    }

    private drag(event: PointerEvent, which: 0 | 1): void {
        event.preventDefault();
        const handle = event.currentTarget as HTMLElement, field = handle.parentElement!.getBoundingClientRect();
        const [low, high] = this.domain; // stays while one drags
        const move = ({ clientX }: PointerEvent): void =>
            this.move(which, low + ((clientX - field.left) / field.width) * (high - low), [low, high]);
        handle.focus();
        followPointer(event, move);
    }

    private key(event: KeyboardEvent, which: 0 | 1): void {
        const [low, high] = this.domain, at = this.ends[which];
        const step = this.isWhole ? Math.max(1, Math.round((high - low) / 100)) : (high - low) / 100;
        const many = event.shiftKey ? 10 * step : step;
        const places: Record<string, number> = {
            ArrowRight: at + many,
            ArrowUp: at + many,
            ArrowLeft: at - many,
            ArrowDown: at - many,
            PageUp: at + 10 * step,
            PageDown: at - 10 * step,
            Home: low,
            End: high,
        };
        const to = places[event.key];
        if (to !== undefined) this.move(which, to, [low, high]);
        else if (event.key === 'Delete' || event.key === 'Backspace') this.tell(null);
        else return;
        event.preventDefault();
        event.stopPropagation();
    }

    /** A handle stops at the ends of the field and at the other one. */
    private move(which: 0 | 1, to: number, [low, high]: Range): void {
        const [from, end] = this.ends;
        const rounded = this.isWhole ? Math.round(to) : Number(to.toPrecision(10));
        const [least, most] = which === 0 ? [low, end] : [from, high];
        const value = Math.min(most, Math.max(least, rounded));
        this.tell(which === 0 ? [value, end] : [from, value]);
    }
    private tell(range: Range | null): void {
        this.dispatchEvent(new CustomEvent('range', { detail: range }) satisfies RangeChange);
    }
}

customElements.define('stipple-histogram', HistogramElement);
