import type { Model } from './model.ts';
import type { ProblemKind, ShownProblem } from './shown_problem.ts';
import type { CloudError, CloudState } from './wasm/values.ts';
import type { Requests } from './wasm/requests.ts';
import type { Viewer } from './wasm/viewer.ts';

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

    list(): ShownProblem[] {
        return this.model.clouds.flatMap((cloud) => {
            const problem = this.problemOf(cloud);
            return problem && !this.hidden.has(keyOf(cloud, problem)) ? [problem] : [];
        });
    }

    /** Of all clouds: 0. */
    retry(cloud: number): void {
        this.model.act(() => this.viewer.retry(cloud));
    }

    /** Tells of clouds whose file was replaced; once for each time. */
    tellReloads(): void {
        for (const { id, name, reloads = 0 } of this.model.clouds) {
            if (reloads > (this.reloads.get(id) ?? 0))
                this.model.notify(this.model.texts.text('clouds.replaced', { name }));
            this.reloads.set(id, reloads);
        }
    }

    private problemOf(cloud: CloudState): ShownProblem | undefined {
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

    private problem(cloud: CloudState, kind: ProblemKind, error: CloudError, instead?: string): ShownProblem {
        const { id, name } = cloud, address = this.model.opened.addressOf(id), { texts } = this.model;
        const { where, what, advice } = texts.saidParts(error.said);
        const isRefused = error.code === 'accessDenied' && address !== undefined;
        const problem: ShownProblem = {
            name,
            kind,
            sentence: texts.asSentence(where ? `${where}: ${what}` : what),
            advice: instead ?? texts.asSentence(advice),
            tokenWasRefused: isRefused && this.requests.hasToken(address),
            ...(isRefused && { giveToken: (token: string) => this.model.access.giveToken(address, token) }),
            retry: () => this.retry(id),
            ...(kind === 'incomplete' ? { hide: () => this.hide(cloud, problem) } : { close: () => this.model.opened.close(id) }),
        };
        return problem;
    }

    private hide(cloud: CloudState, problem: ShownProblem): void {
        this.hidden.add(keyOf(cloud, problem));
        this.model.changed();
    }

    private readonly networkIsBack = (): void => {
        for (const { id, error, interrupted } of this.model.clouds)
            if ((error ?? interrupted)?.code === 'networkFailed') this.retry(id);
    };
}

function keyOf({ id }: CloudState, { kind, sentence }: ShownProblem): string {
    return [id, kind, sentence].join();
}
