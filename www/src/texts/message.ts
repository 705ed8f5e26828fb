import type { english } from './english.ts';

/** A text, or one for each plural form that the language has (Unicode CLDR's names). */
export type Message = string | Plural;
export type Plural = { other: string } & Partial<Record<Intl.LDMLPluralRule, string>>;

export type Key = keyof typeof english;
export type Catalogue = Readonly<Record<Key, Message>>;

/** The {names} in a message. */
type NamesIn<S extends string> = S extends `${string}{${infer Name}}${infer Rest}` ? Name | NamesIn<Rest> : never;
export type Names<M> = M extends string ? NamesIn<M> : M extends object ? NamesIn<M[keyof M] & string> | 'count' : never;

/** What a message needs besides its key: nothing, or its values. Numbers are written as the language writes them. */
export type Values<K extends Key> = [Names<(typeof english)[K]>] extends [never]
    ? []
    : [values: Record<Names<(typeof english)[K]>, string | number>];

/** Of the messages of T those whose values are not the English message's; `count` may go without saying. */
type Differing<T> = {
    [K in Key & keyof T]: [Names<T[K]>, Exclude<Names<(typeof english)[K]>, 'count'>] extends [
        Names<(typeof english)[K]>,
        Names<T[K]>,
    ]
        ? never
        : K;
}[Key & keyof T];

/** A catalogue in another language: every message, each with the values of the English one, or it does not compile. */
export function translation<const T extends Catalogue>(
    messages: T & ([Differing<T>] extends [never] ? unknown : { 'values differ from the English message of': Differing<T> }),
): Catalogue {
    return messages;
}

/** Something that went wrong, to be told in the person's language: `Texts.sentenceOf`. */
export class Problem<K extends Key = Key> extends Error {
    readonly values: Values<K>;
    constructor(
        readonly key: K,
        ...values: Values<K>
    ) {
        super(key);
        this.values = values;
    }
}
