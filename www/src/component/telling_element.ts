import type { StippleViewerEventName, StippleViewerEvents } from './events.ts';

/** An element that tells the events of `StippleViewerEvents`, and whose listeners know what each brings. */
export class TellingElement extends HTMLElement {
    /** @internal */
    tell<K extends StippleViewerEventName>(name: K, detail: StippleViewerEvents[K]): void {
        this.dispatchEvent(new CustomEvent(name, { detail }));
    }
}

type Listener<This, K extends StippleViewerEventName> = (this: This, event: CustomEvent<StippleViewerEvents[K]>) => unknown;

export interface TellingElement {
    addEventListener<K extends StippleViewerEventName>(name: K, listener: Listener<this, K>, options?: boolean | AddEventListenerOptions): void;
    addEventListener<K extends keyof HTMLElementEventMap>(
        name: K,
        listener: (this: this, event: HTMLElementEventMap[K]) => unknown,
        options?: boolean | AddEventListenerOptions,
    ): void;
    removeEventListener<K extends StippleViewerEventName>(name: K, listener: Listener<this, K>, options?: boolean | EventListenerOptions): void;
    removeEventListener<K extends keyof HTMLElementEventMap>(
        name: K,
        listener: (this: this, event: HTMLElementEventMap[K]) => unknown,
        options?: boolean | EventListenerOptions,
    ): void;
}
