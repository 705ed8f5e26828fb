import type { Model } from '../model.ts';
import { type Snapshot, snapshot } from './snapshot.ts';

/** What was changed until one of these is a step of its own. */
const gestures = ['pointerdown', 'keydown'];

/** With a person's first gesture in `host` comes what takes steps back (history.ts); until it is here, what there was before each is kept for it. */
export function followGestures(host: HTMLElement, model: Model, signal: AbortSignal): void {
    const early: Snapshot[] = [], here = new AbortController();
    const load = async (): Promise<void> => {
        const [{ History }] = await Promise.all([import('./history.ts'), import('../ui/undo_buttons.ts')]);
        here.abort();
        if (signal.aborted) return;
        model.history = new History(model, host, early, signal);
        model.changed();
    };
    const keep = (): void => {
        if (early.push(snapshot(model)) === 1) load().catch((error: unknown) => model.tell(error));
    };
    for (const gesture of gestures) host.addEventListener(gesture, keep, { capture: true, signal: AbortSignal.any([signal, here.signal]) });
}
