import type { Part } from './stored_ranges.ts';

/** What an answer's header says; empty where it says nothing, or -1. */
export interface Fields {
    contentRange: string;
    etag: string;
    lastModified: string;
    retryAfter: string;
    contentLength: number;
}

export function fieldsOf(response: Response): Fields {
    const field = (name: string): string => response.headers.get(name) ?? '';
    const isCoded = field('content-encoding') !== '';
    return {
        contentRange: field('content-range'),
        etag: field('etag'),
        lastModified: field('last-modified'),
        retryAfter: inSeconds(field('retry-after'), field('date')),
        contentLength: isCoded || field('content-length') === '' ? -1 : Number(field('content-length')),
    };
}

/** A Retry-After: of a date, the seconds after the answer's own, or after now where that is not shown (shared/io/retry_after.hpp). */
function inSeconds(retryAfter: string, date: string): string {
    const timeOf = (text: string): number => Date.parse(/ GMT$/.test(text) ? text : `${text} GMT`);
    const until = /^[A-Z][a-z]+,? /.test(retryAfter) ? timeOf(retryAfter) : NaN, from = timeOf(date);
    if (Number.isNaN(until)) return retryAfter;
    return String(Math.max(0, Math.ceil((until - (Number.isNaN(from) ? Date.now() : from)) / 1000)));
}

/** Of "bytes=0-65535". */
export function spanOf(range: string): Part {
    const [first, last] = range.slice('bytes='.length).split('-').map(Number) as [number, number];
    return { at: first, end: last + 1 };
}
/** The value of a request's Range. */
export function rangeOf({ at, end }: Part): string {
    return `bytes=${at}-${end - 1}`;
}
/** The Content-Range of a right answer. */
export function contentRangeOf({ at, end }: Part, sizeBytes: number): string {
    return `bytes ${at}-${end - 1}/${sizeBytes}`;
}
export function isGap({ bytes }: Part): boolean {
    return bytes === undefined;
}
