import type { Model } from '../model.ts';
import { type Snapshot, snapshot } from './snapshot.ts';

const mostSteps = 100;
/** Of measurements: what follows from the rest. */
const followsFromTheRest = ['answer', 'error', 'share'];

/**
 * Takes back what a person made, changed or deleted with the tools, and does it again. A step is what changes between one gesture (a pointer
 * or a key goes down) and the next: a drag, a click, a key, however long its answer takes. The camera has a history of its own.
 */
export class History {
    private past: Snapshot[] = [];
    private future: Snapshot[] = [];
    /** As it was at the last gesture. */
    private present: Snapshot;
    /** A field whose text was not taken yet: its steps back are the browser's. */
    private typing: EventTarget | undefined;

    /** `early`: how it was at first, and at the gestures since. */
    constructor(
        private readonly model: Model,
        private readonly host: HTMLElement,
        early: Snapshot[],
        signal: AbortSignal,
    ) {
        this.present = early[0] ?? snapshot(model);
        for (const moment of early.slice(1)) this.take(moment);
        const on = (name: string, act: (event: Event) => void): void => host.addEventListener(name, act, { capture: true, signal });
        on('pointerdown', () => this.take(snapshot(model)));
        on('keydown', (event) => this.key(event as KeyboardEvent));
        on('input', (event) => (this.typing = event.composedPath()[0]));
        on('click', (event) => this.click(event));
    }

    get canUndo(): boolean {
        return this.past.length > 0 || !same(this.present, snapshot(this.model));
    }
    get canRedo(): boolean {
        return this.future.length > 0 && same(this.present, snapshot(this.model));
    }

    /** A step back; of a drawing, its last point. */
    undo(): void {
        const { tool } = this.model;
        if (tool) return tool.takeBackInTurn();
        this.take(snapshot(this.model));
        this.go(this.past, this.future);
    }
    redo(): void {
        if (this.model.tool) return;
        this.take(snapshot(this.model));
        this.go(this.future, this.past);
    }
    /** Something else is shown: nothing of what was before can be had back. */
    restart(): void {
        [this.past, this.future, this.present] = [[], [], snapshot(this.model)];
    }

    private take(now: Snapshot): void {
        if (same(this.present, now)) return;
        this.past = [...this.past, this.present].slice(-mostSteps);
        this.future = [];
        this.present = now;
    }
    private go(from: Snapshot[], to: Snapshot[]): void {
        const next = from.pop();
        if (!next) return;
        to.push(this.present);
        restore(this.model, next);
        this.present = snapshot(this.model);
        this.model.changed();
    }

    private key(event: KeyboardEvent): void {
        const step = stepOf(event), [at] = event.composedPath();
        if (step && !(this.typing === at && isText(at))) {
            event.preventDefault();
            this[step]();
        } else if (!event.repeat) {
            this.take(snapshot(this.model));
            if (event.key === 'Tab' || (event.key === 'Enter' && at instanceof HTMLInputElement)) this.typing = undefined; // it was taken
        }
    }

    private click(event: Event): void {
        const [at] = event.composedPath();
        if (this.typing && this.typing !== at) {
            this.take(snapshot(this.model)); // the field was left with the pointer's going down, and its text taken
            this.typing = undefined;
        }
        this.keepFocus(at);
    }
    /** A button that goes with what it deletes leaves the focus to nobody: the picture has it then, and keys go on being heard. */
    private keepFocus(at: EventTarget | undefined): void {
        requestAnimationFrame(() => {
            if (at instanceof Node && !at.isConnected && this.host.shadowRoot?.activeElement === null) this.model.canvas.focus({ preventScroll: true });
        });
    }
}

function stepOf({ key, ctrlKey, metaKey, altKey, shiftKey }: KeyboardEvent): 'undo' | 'redo' | undefined {
    if (altKey || ctrlKey === metaKey) return undefined;
    const letter = key.toLowerCase();
    if (letter === 'z') return shiftKey ? 'redo' : 'undo';
    return letter === 'y' && !shiftKey ? 'redo' : undefined;
}

function isText(at: EventTarget | undefined): boolean {
    if (at instanceof HTMLInputElement) return !['range', 'checkbox', 'radio', 'color', 'file'].includes(at.type);
    return at instanceof HTMLTextAreaElement;
}

function same(a: Snapshot, b: Snapshot): boolean {
    const text = (value: unknown): string => JSON.stringify(value, (key, part) => (followsFromTheRest.includes(key) ? undefined : part)) ?? '';
    return (Object.keys(a) as (keyof Snapshot)[]).every((part) => a[part] === b[part] || text(a[part]) === text(b[part]));
}

function restore({ clipping, measuring, annotations, film, profile }: Model, to: Snapshot): void {
    const { line, width, exaggeration } = profile;
    if (!to.profile) {
        if (profile.isOpen) profile.close();
    } else if (!profile.isOpen || line !== to.profile.line || width !== to.profile.width) profile.show({ ...to.profile, exaggeration });
    clipping.restore(to.boxes, to.regions); // the profile's corridor, too
    measuring.restore(to.measured);
    annotations.restore(to.annotations);
    if (film.keyframes !== to.keyframes) film.replace(to.keyframes);
}
