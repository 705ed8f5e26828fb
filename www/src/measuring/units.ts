/** Units that lengths are shown in; metres of one as in client/survey/units.hpp. */
export type DisplayUnit = 'stored' | 'm' | 'ft' | 'us-ft';

export const displayUnits: DisplayUnit[] = ['stored', 'm', 'ft', 'us-ft'];

const metres: Record<Exclude<DisplayUnit, 'stored'>, number> = { m: 1, ft: 0.3048, 'us-ft': 1200 / 3937 };
const symbols: Record<Exclude<DisplayUnit, 'stored'>, string> = { m: 'm', ft: 'ft', 'us-ft': 'ft US' };
const powers = ['', '', '²', '³'];

export interface StoredUnit {
    unit: string;
    unitMeters: number;
}

/** A length (power 1), area (2) or volume (3) in the wanted unit; in the cloud's where that is not known in metres. */
export function inUnit(value: number, power: number, stored: StoredUnit, wanted: DisplayUnit): number {
    return wanted === 'stored' || stored.unitMeters === 0
        ? value
        : value * (stored.unitMeters / metres[wanted]) ** power;
}

export function unitSymbol(power: number, stored: StoredUnit, wanted: DisplayUnit): string {
    const symbol = wanted === 'stored' || stored.unitMeters === 0 ? symbolOf(stored) : symbols[wanted];
    return symbol + (symbol && powers[power]!);
}

function symbolOf({ unit, unitMeters }: StoredUnit): string {
    const known = (Object.keys(metres) as (keyof typeof metres)[]).find(
        (name) => Math.abs(metres[name] / unitMeters - 1) < 1e-9,
    );
    return known ? symbols[known] : unit;
}

/** As many as the deviation bears out: two significant digits of it, at most `most`. */
export function decimalsOf(deviation = 0, most = 4): number {
    return deviation > 0 ? Math.max(0, Math.min(most, 1 - Math.floor(Math.log10(deviation)))) : most;
}
