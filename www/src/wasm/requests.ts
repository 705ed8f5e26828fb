import { Problem } from '../texts/message.ts';

/** What a page makes of a request; what it leaves out stays as it is. */
export interface PreparedRequest {
    /** Another address, for example with a signature. Messages and saved scenes keep the cloud's own. */
    url?: string;
    headers?: Record<string, string>;
    /** As of fetch(); 'same-origin' if left out. */
    credentials?: RequestCredentials;
}

/**
 * Called before each request: for bytes `range` ("bytes=0-65535") of the cloud at `url`, or, without a range, for a server's list of clouds, a
 * profile or a file that it makes. May take its time: the request waits, and counts as under way. If it throws, the page says why; a cloud is
 * tried again like after a network failure.
 */
export type PrepareRequest = (
    url: string,
    range?: string,
) => PreparedRequest | undefined | Promise<PreparedRequest | undefined>;

/** A server wants other credentials (401, 403). */
export class Refused extends Problem<'access.refused'> {
    constructor(
        readonly url: string,
        readonly status: number,
    ) {
        super('access.refused', { status: String(status) });
    }
}

/**
 * How requests are sent: as the embedding page prepares them, with the token that a person gave for the
 * origin. Tokens are kept in memory only, and go to their own origin only.
 */
export class Requests {
    prepare: PrepareRequest | undefined;
    /** What came may stay in the browser for the next visit, up to so many bytes (stored_ranges.ts); 0: nothing. */
    storeBytes = 0;
    private readonly tokens = new Map<string, string>(); // by origin

    /** For the server of that address; an empty one forgets it. */
    setToken(url: string, token: string): void {
        const { origin } = new URL(url, document.baseURI);
        if (token === '') this.tokens.delete(origin);
        else this.tokens.set(origin, token);
    }
    hasToken(url: string): boolean {
        return this.tokens.has(new URL(url, document.baseURI).origin);
    }

    /** Whether requests there carry something that a link does not. */
    addTo(url: string): boolean {
        return this.prepare !== undefined || this.hasToken(url);
    }

    /** Sends one for anything but bytes of a cloud. Throws `Refused`. */
    async fetch(url: string, init: RequestInit = {}): Promise<Response> {
        const prepared = await this.prepared(url);
        const response = await fetch(prepared.url, { ...init, ...prepared.init });
        if (response.status === 401 || response.status === 403) throw new Refused(url, response.status);
        return response;
    }

    async prepared(url: string, range?: string): Promise<{ url: string; init: RequestInit }> {
        const made = (await this.prepare?.(url, range)) ?? {};
        const address = new URL(made.url ?? url, document.baseURI);
        const token = this.tokens.get(address.origin);
        const headers = {
            ...(token !== undefined && { Authorization: `Bearer ${token}` }),
            ...made.headers,
            ...(range !== undefined && { Range: range }),
        };
        // Browsers' caches serialise ranges of one address and have mixed them up; the viewer has its own.
        const init: RequestInit = range === undefined ? { headers } : { cache: 'no-store', headers };
        if (made.credentials !== undefined) init.credentials = made.credentials;
        return { url: address.href, init };
    }
}

/** Whether browsers keep a page that came over https from asking there. */
export function isMixedContent(url: string): boolean {
    const { protocol, hostname } = new URL(url);
    const isOwnMachine = /^(localhost|.*\.localhost|127(\.\d+){3}|\[::1\])$/.test(hostname);
    return location.protocol === 'https:' && protocol === 'http:' && !isOwnMachine;
}

/**
 * After a request that browsers tell nothing of: whether a server of another origin is there, so that the reason
 * must be that it does not allow this page to read what it answers.
 */
export async function isThereButNotAllowed(url: string, signal: AbortSignal): Promise<boolean> {
    if (new URL(url).origin === location.origin) return false;
    try {
        await fetch(url, { method: 'HEAD', mode: 'no-cors', cache: 'no-store', credentials: 'omit', signal });
        return true;
    } catch {
        return false;
    }
}
