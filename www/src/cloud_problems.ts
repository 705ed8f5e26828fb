import type { Model } from './model.ts';
import type { CloudError, CloudState } from './wasm/values.ts';
import type { Requests } from './wasm/requests.ts';
import type { Viewer } from './wasm/viewer.ts';

/**
 * `stopped`: nothing more comes until somebody does something. `retrying`: it is tried again by itself. `incomplete`: a
 * part of the cloud is given up, the rest is shown.
 */
export type ProblemKind = 'stopped' | 'retrying' | 'incomplete';

/** What is wrong with an open cloud, and what can be done. */
export interface CloudProblem {
    cloud: number;
    name: string;
    kind: ProblemKind;
    /** What happened. */
    sentence: string;
    /** What to do about it; may be empty. */
    advice: string;
    /** A token may help. */
    wantsToken: boolean;
    /** One was given, and did not. */
    tokenWasRefused: boolean;
}

/** The problems of the open clouds, as their states tell of them, and the ways out. The camera and all that is here stay. */
export class CloudProblems {
    private readonly reloads = new Map<number, number>(); // told already, by cloud
    private readonly hidden = new Set<string>();

    constructor(
        private readonly model: Model,
        private readonly viewer: Viewer,
        private readonly requests: Requests,
    ) {
        addEventListener('online', this.networkIsBack);
    }

    /** Nothing is followed any more. */
    stop(): void {
        removeEventListener('online', this.networkIsBack);
    }

    list(): CloudProblem[] {
        return this.model.clouds
            .flatMap((cloud) => this.problemOf(cloud) ?? [])
            .filter((problem) => !this.hidden.has(keyOf(problem)));
    }

    /** Of what does not mend by itself. */
    sentences(): string[] {
        return this.list().flatMap(({ kind, sentence }) => (kind === 'retrying' ? [] : [sentence]));
    }

    /** Of all clouds: 0. */
    retry(cloud: number): void {
        this.model.act(() => this.viewer.retry(cloud));
    }

    /** Sends the token to the cloud's server, from now on until the page is closed. */
    giveToken(cloud: number, token: string): void {
        const address = this.model.addressOf(cloud);
        if (address === undefined) return;
        this.requests.setToken(address, token.trim());
        this.retry(cloud);
    }

    hide(problem: CloudProblem): void {
        this.hidden.add(keyOf(problem));
        this.model.changed();
    }

    /** Tells of clouds whose file was replaced; once for each time. */
    tellReloads(): void {
        for (const { id, name, reloads = 0 } of this.model.clouds) {
            if (reloads > (this.reloads.get(id) ?? 0))
                this.model.notify(this.model.texts.text('clouds.replaced', { name }));
            this.reloads.set(id, reloads);
        }
    }

    private problemOf(cloud: CloudState): CloudProblem | undefined {
        const { texts } = this.model;
        const stopped = cloud.error ?? cloud.interrupted;
        if (stopped) return this.problem(cloud, 'stopped', stopped);
        if (cloud.retrying) {
            const seconds = Math.ceil(cloud.retrySeconds ?? 0);
            const advice = seconds > 0 ? texts.text('problem.retryIn', { seconds }) : texts.text('problem.retrying');
            return this.problem(cloud, 'retrying', cloud.retrying, advice);
        }
        if (cloud.missing) {
            const { nodes, chunks, last } = cloud.missing;
            const lost = [
                ...(nodes > 0 ? [texts.text('problem.nodes', { count: nodes })] : []),
                ...(chunks > 0 ? [texts.text('problem.chunks', { count: chunks })] : []),
            ];
            const problem = this.problem(cloud, 'incomplete', last);
            const reason = problem.sentence;
            problem.sentence = texts.text('problem.incomplete', { missing: texts.list(lost), reason });
            return problem;
        }
        return undefined;
    }

    private problem(cloud: CloudState, kind: ProblemKind, error: CloudError, advice = sentence(error.advice)): CloudProblem {
        const address = this.model.addressOf(cloud.id);
        const isRefused = error.code === 'accessDenied' && address !== undefined;
        return {
            cloud: cloud.id,
            name: cloud.name,
            kind,
            sentence: sentence(error.where ? `${error.where}: ${error.what}` : error.what),
            advice,
            wantsToken: isRefused,
            tokenWasRefused: isRefused && this.requests.hasToken(address),
        };
    }

    private readonly networkIsBack = (): void => {
        for (const { id, error, interrupted } of this.model.clouds)
            if ((error ?? interrupted)?.code === 'networkFailed') this.retry(id);
    };
}

function keyOf({ cloud, kind, sentence }: CloudProblem): string {
    return [cloud, kind, sentence].join();
}
function sentence(text: string): string {
    return text === '' ? '' : `${text[0]!.toUpperCase()}${text.slice(1)}.`;
}
