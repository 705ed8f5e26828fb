import type { CloudFacts, ColourMode, Histogram, HistogramRequest, Style } from '../wasm/values.ts';

export type RangeField = 'intensityRange' | 'elevationRange' | 'levelRange' | 'attributeRange';
export type Range = [number, number];

/** The field of the style that has a colour mode's range along the gradient; none for modes without a gradient. */
export const rangeFields: Partial<Record<ColourMode, RangeField>> = {
    intensity: 'intensityRange',
    elevation: 'elevationRange',
    level: 'levelRange',
    returnNumber: 'attributeRange',
    numberOfReturns: 'attributeRange',
    pointSourceId: 'attributeRange',
    gpsTime: 'attributeRange',
    attribute: 'attributeRange',
};

/** The attribute that a mode shows, by its name in the file; none: the mode shows no attribute, or several. */
export function attributeOfMode({ colourMode, attribute }: Pick<Style, 'colourMode' | 'attribute'>): string | undefined {
    const names: Partial<Record<ColourMode, string>> = {
        intensity: 'Intensity',
        classification: 'Classification',
        returnNumber: 'Return Number',
        numberOfReturns: 'Number of Returns',
        pointSourceId: 'Point Source ID',
        gpsTime: 'GPS Time',
        attribute,
    };
    return names[colourMode];
}

export const histogramBins = 64;

/** What to count for the range of the style's colours; nothing for modes whose values are not counted. */
export function colourRequest(style: Style): HistogramRequest | undefined {
    const { colourMode } = style;
    if (!rangeFields[colourMode] || colourMode === 'level') return undefined;
    return { colourMode, ...(colourMode === 'attribute' && { attribute: style.attribute }), bins: histogramBins };
}
export function attributeRequest(attribute: string): HistogramRequest {
    return { colourMode: 'attribute', attribute, bins: histogramBins };
}
export const classRequest: HistogramRequest = { colourMode: 'classification', bins: 256, range: [-0.5, 255.5] };

/** As the program takes intensities from a cloud's statistics: mean ± 2 deviations within the least and greatest; of others all. */
export function typicalRange({ min, max, mean, deviation }: Histogram, colourMode: ColourMode): Range {
    if (colourMode !== 'intensity') return [min, max];
    return [Math.max(min, mean - 2 * deviation), Math.min(max, mean + 2 * deviation)];
}

/** The unit of what a mode shows: of its attribute, or of heights; '' where it has none or is not known. */
export function unitOf(style: Style, facts: CloudFacts[]): string {
    if (style.colourMode === 'elevation') return facts.find(({ crs }) => crs.unit !== '')?.crs.unit ?? '';
    const name = attributeOfMode(style)?.toLowerCase();
    for (const { attributes } of facts)
        for (const attribute of attributes) if (attribute.name.toLowerCase() === name && attribute.unit) return attribute.unit;
    return '';
}

/** Some values from `min` to `max` that are short to write: multiples of 1, 2 or 5 times a power of ten. */
export function ticks([min, max]: Range, most = 5): number[] {
    const raw = (max - min) / Math.max(1, most);
    if (!(raw > 0) || !Number.isFinite(raw)) return [min];
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = power * ([1, 2, 5, 10].find((factor) => factor * power >= raw * (1 - 1e-9)) ?? 10);
    const first = Math.ceil(min / step - 1e-9), last = Math.floor(max / step + 1e-9);
    return Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}

/** To as many digits as tell values apart that are a hundredth of `span` from each other. */
export function roundInSpan(value: number, span: number): number {
    const digits = span > 0 ? Math.max(0, Math.min(8, 2 - Math.floor(Math.log10(span)))) : 3;
    return Number(value.toFixed(digits));
}
