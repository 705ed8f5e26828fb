import type { Names } from '../message.ts';
import type { Phrases } from '../said.ts';
import type { Pattern } from './english.ts';

/** Of the phrases of T those whose values are not the pattern's. */
type Differing<T> = {
    [K in Pattern & keyof T]: [Names<K>, Names<T[K]>] extends [Names<T[K]>, Names<K>] ? never : K;
}[Pattern & keyof T];

/** The program's phrases in another language: every pattern, each with its values, or it does not compile. */
export function phrasesOf<const T extends Record<Pattern, string>>(
    phrases: T & ([Differing<T>] extends [never] ? unknown : { 'values differ from the pattern of': Differing<T> }),
): Phrases {
    return phrases;
}
