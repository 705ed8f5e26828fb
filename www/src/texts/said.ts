/** Sentences of the program in another language, by their patterns: the English text with {0}, {1} … for its values. */
export type Phrases = Readonly<Record<string, string>>;

const valueBegins = '\x02', valueEnds = '\x03', fieldEnds = '\x1e';

/** What went wrong in the program, as it says it (Error::said, shared/base/result.hpp): `Texts.sentenceOf` says it in the person's language. */
export class Said extends Error {
    constructor(readonly said: string) {
        super(sentenceOf(said));
    }
}

export function sentenceOf(said: string, phrases: Phrases = {}): string {
    const { where, what, advice } = partsOf(said, phrases);
    return `${where && `${where}: `}${what}${advice && ` (${advice})`}`;
}

/** Where, what and what to do; where and what to do may be empty. */
export function partsOf(said: string, phrases: Phrases = {}): { where: string; what: string; advice: string } {
    const [first = '', what, advice = ''] = said.split(fieldEnds);
    const say = (marked: string): string => phraseOf(marked, phrases);
    return what === undefined ? { where: '', what: say(first), advice: '' } : { where: first, what: say(what), advice: say(advice) };
}

/** shared/base/phrase.hpp: values stand between marks, and may be phrases with values of their own. */
function phraseOf(marked: string, phrases: Phrases): string {
    const values: string[] = [];
    let pattern = '', depth = 0;
    for (const c of marked) {
        if (c === valueBegins && depth++ === 0) pattern += `{${values.push('') - 1}}`;
        else if (c === valueEnds && --depth === 0) continue;
        else if (depth > 0) values[values.length - 1] += c;
        else pattern += c;
    }
    const form = Object.hasOwn(phrases, pattern) ? phrases[pattern]! : pattern;
    return form.replace(/\{(\d)\}/g, (_, index: string) => phraseOf(values[Number(index)]!, phrases));
}
