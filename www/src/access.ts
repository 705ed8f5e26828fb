import type { Model } from './model.ts';
import type { ShownProblem } from './shown_problem.ts';
import { Refused } from './wasm/requests.ts';

/** What a page asks of servers besides clouds. */
export type Purpose = 'list' | 'profile' | 'file';

/** What servers refused, besides clouds, and the tokens that a person gives. */
export class Access {
    private readonly refusals = new Map<Purpose, { refused: Refused; retry: () => void }>();

    constructor(private readonly model: Model) {}

    /** True: a server's refusal is what went wrong, and it is a problem now, until it is hidden or granted. */
    takes(error: unknown, purpose: Purpose, retry: () => void): boolean {
        if (!(error instanceof Refused)) return false;
        this.refusals.set(purpose, { refused: error, retry });
        this.model.changed();
        return true;
    }
    granted(purpose: Purpose): void {
        if (this.refusals.delete(purpose)) this.model.changed();
    }

    problems(): ShownProblem[] {
        const { texts, requests } = this.model;
        return [...this.refusals].map(([purpose, { refused, retry }]) => ({
            name: new URL(refused.url).host,
            kind: 'stopped',
            sentence: texts.text(`access.${purpose}`, { status: String(refused.status) }),
            advice: texts.text('access.advice'),
            tokenWasRefused: requests.hasToken(refused.url),
            giveToken: (token) => this.giveToken(refused.url, token),
            retry,
            hide: () => this.granted(purpose),
        }));
    }

    /** Sends the token to the server of that address, from now on until the page is closed; asks again for all that it refused. */
    giveToken(url: string, token: string): void {
        const { model } = this, { origin } = new URL(url, document.baseURI);
        model.requests.setToken(url, token.trim());
        for (const { id, error, interrupted } of model.clouds) {
            const isRefused = (error ?? interrupted)?.code === 'accessDenied';
            if (isRefused && new URL(model.opened.addressOf(id) ?? 'file:', document.baseURI).origin === origin) model.problems.retry(id);
        }
        const refused = [...this.refusals.values()].filter(({ refused }) => new URL(refused.url).origin === origin);
        if (model.server?.origin === origin && !this.refusals.has('list')) void model.listing.anew(); // lists have what one may read
        for (const { retry } of refused) retry();
    }
}
