import { english } from './english.ts';
import { type Catalogue, type Key, type Message, Problem, type Values } from './message.ts';
import { partsOf, type Phrases, Said, sentenceOf } from './said.ts';

/** Of a language: all that the page says, and what the program says (which says it in English). */
interface Words {
    catalogue: Catalogue;
    phrases: Phrases;
}

/** The languages that there are catalogues of; all but English are loaded when they are wanted. */
const catalogues = {
    en: async (): Promise<Words> => ({ catalogue: english, phrases: {} }),
    de: async (): Promise<Words> => (await import('./german_words.ts')).german,
    fr: async (): Promise<Words> => (await import('./french_words.ts')).french,
    ja: async (): Promise<Words> => (await import('./japanese_words.ts')).japanese,
};
export type Language = keyof typeof catalogues;
export const languages = Object.keys(catalogues) as Language[];

/** The first of the wanted languages (BCP 47, as `navigator.languages`) that there is a catalogue of, with its region; else English. */
export function bestLanguage(wanted: readonly string[]): { language: Language; locale: string } {
    for (const tag of wanted) {
        const language = tag.toLowerCase().split(/[-_]/)[0] as Language;
        if (languages.includes(language)) return { language, locale: localeOf(tag, language) };
    }
    return { language: 'en', locale: 'en' };
}

function localeOf(tag: string, language: Language): string {
    try {
        return Intl.getCanonicalLocales(tag.replaceAll('_', '-'))[0] ?? language;
    } catch {
        return language; // not a tag, but for its beginning
    }
}

export async function loadTexts(wanted: readonly string[]): Promise<Texts> {
    const { language, locale } = bestLanguage(wanted);
    const { catalogue, phrases } = await catalogues[language]();
    return new Texts(language, locale, catalogue, phrases);
}

/** What is said to a person, and numbers as they write them. */
export class Texts {
    private readonly rules: Intl.PluralRules;
    private readonly counts: Intl.NumberFormat;
    private readonly compacts: Intl.NumberFormat;

    constructor(
        readonly language: Language = 'en',
        readonly locale: string = language,
        private readonly catalogue: Catalogue = english,
        private readonly phrases: Phrases = {},
    ) {
        this.rules = new Intl.PluralRules(locale);
        this.counts = new Intl.NumberFormat(locale, { maximumFractionDigits: 0 });
        this.compacts = new Intl.NumberFormat(locale, { notation: 'compact', maximumSignificantDigits: 3 });
    }

    text<K extends Key>(key: K, ...[values]: Values<K>): string {
        return this.fill(this.catalogue[key], values ?? {});
    }

    /** The sentence of whatever was thrown. */
    sentenceOf(error: unknown): string {
        if (error instanceof Problem) return this.text(error.key, ...(error.values as Values<Key>));
        if (error instanceof Said) return this.said(error.said);
        return error instanceof Error ? error.message : String(error);
    }

    /** What the program says, and its parts. */
    said(said: string): string {
        return sentenceOf(said, this.phrases);
    }
    saidParts(said: string): ReturnType<typeof partsOf> {
        return partsOf(said, this.phrases);
    }
    /** With a full stop, and a capital unless it begins with an address or a file; empty if the text is. */
    asSentence(text: string): string {
        const first = /^\S+[./]\S/.test(text) ? text[0] : text[0]?.toLocaleUpperCase(this.locale);
        return first ? this.text('page.sentence', { text: first + text.slice(1) }) : '';
    }

    /** Of a name that comes from elsewhere (a class of LAS): its message `prefix.name`, if there is one. */
    translated(prefix: string, name: string): string {
        const key = `${prefix}.${name}`;
        return Object.hasOwn(english, key) ? this.fill(this.catalogue[key as Key], {}) : name;
    }

    count(value: number): string {
        return this.counts.format(value);
    }
    compact(value: number): string {
        return this.compacts.format(value);
    }
    bytes(value: number): string {
        const units = this.text('page.byteUnits').split(' ');
        let unit = 0;
        while (value >= 1024 && unit < units.length - 1) {
            value /= 1024;
            unit++;
        }
        return `${this.decimals(value, value >= 100 || unit === 0 ? 0 : 1)} ${units[unit]}`;
    }
    /** With so many decimals, and without separators of thousands, as surveyors write coordinates. */
    decimals(value: number, decimals: number): string {
        return new Intl.NumberFormat(this.locale, {
            minimumFractionDigits: decimals,
            maximumFractionDigits: decimals,
            useGrouping: false,
        }).format(value);
    }
    /** With all its digits. */
    number(value: number): string {
        const [, decimals = ''] = /^-?\d+(?:\.(\d+))?$/.exec(String(value)) ?? [];
        return /e/.test(String(value)) ? String(value) : this.decimals(value, decimals.length);
    }
    list(items: string[]): string {
        return new Intl.ListFormat(this.locale).format(items);
    }

    private fill(message: Message, values: Partial<Record<string, string | number>>): string {
        const form =
            typeof message === 'string' ? message : (message[this.rules.select(Number(values['count']))] ?? message.other);
        return form.replace(/\{(\w+)\}/g, (whole, name: string) => {
            const value = values[name];
            if (value === undefined) return whole;
            return typeof value === 'number' ? this.count(value) : value;
        });
    }
}
