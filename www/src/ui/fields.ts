import { html, nothing, type TemplateResult } from 'lit';

/** One of a few, as a row of labelled radio buttons. */
export function choice<T extends string>(
    label: string,
    name: string,
    value: T,
    options: [T, string][],
    change: (value: T) => void,
): TemplateResult {
    return html`<div class="row" role="radiogroup" aria-label=${label}>
        <span>${label}</span>
        <div class="choice">
            ${options.map(
                ([option, text]) =>
                    html`<label>
                        <input
                            type="radio"
                            name=${name}
                            value=${option}
                            aria-label=${`${label}: ${text}`}
                            .checked=${option === value}
                            @change=${() => change(option)}
                        /><span>${text}</span>
                    </label>`,
            )}
        </div>
    </div>`;
}

/** Yes or no. */
export function checkbox(label: string, value: boolean, change: (value: boolean) => void): TemplateResult {
    return html`<label class="row">
        <span>${label}</span>
        <span>
            <input
                type="checkbox"
                aria-label=${label}
                .checked=${value}
                @change=${(event: Event) => change((event.target as HTMLInputElement).checked)}
            />
        </span>
    </label>`;
}

/** One of many, as a list to pull down. */
export function select<T extends string>(
    label: string,
    value: T,
    options: [T, string][],
    change: (value: T) => void,
): TemplateResult {
    return html`<label class="row">
        <span>${label}</span>
        <select @change=${(event: Event) => change((event.target as HTMLSelectElement).value as T)}>
            ${options.map(
                ([option, text]) => html`<option value=${option} ?selected=${option === value}>${text}</option>`,
            )}
        </select>
    </label>`;
}

export interface Scale {
    min: number;
    max: number;
    /** Each step of the slider multiplies: for quantities that span decades. */
    logarithmic?: boolean;
    /** Significant digits of the values it gives; 3 unless told. */
    digits?: number;
}

/** A number between two ends. */
export function slider(
    label: string,
    value: number,
    scale: Scale,
    shown: string,
    change: (value: number) => void,
    disabled = false,
): TemplateResult {
    const to = scale.logarithmic ? Math.log : (x: number) => x;
    const from = scale.logarithmic ? Math.exp : (x: number) => x;
    const place = (to(value) - to(scale.min)) / (to(scale.max) - to(scale.min));
    const read = (event: Event): number => {
        const at = Number((event.target as HTMLInputElement).value) / 1000;
        return Number(from(to(scale.min) + at * (to(scale.max) - to(scale.min))).toPrecision(scale.digits ?? 3));
    };
    return html`<label class="row">
        <span>${label}</span>
        <span class="value">
            <input
                type="range"
                min="0"
                max="1000"
                aria-label=${label}
                aria-valuetext=${shown}
                .value=${String(Math.round(place * 1000))}
                ?disabled=${disabled}
                @input=${(event: Event) => change(read(event))}
            />
            <output aria-hidden="true">${shown || nothing}</output>
        </span>
    </label>`;
}
