import { LitElement } from 'lit';

import type { Model } from '../model.ts';
import type { Key, Values } from '../texts/message.ts';
import type { Texts } from '../texts/texts.ts';

/** An element that shows the model, and shows it again when it, or one of its `sources`, changed. */
export class ModelElement extends LitElement {
    static override properties = { model: { attribute: false } };
    declare model: Model;

    protected readonly follow = (): void => this.requestUpdate();
    /** What it shows beside the model itself: each tells of its changes by 'change'. */
    protected sources(): EventTarget[] {
        return [];
    }

    override connectedCallback(): void {
        super.connectedCallback();
        for (const source of [this.model, ...this.sources()]) source.addEventListener('change', this.follow);
    }
    override disconnectedCallback(): void {
        for (const source of [this.model, ...this.sources()]) source.removeEventListener('change', this.follow);
        super.disconnectedCallback();
    }

    /** A message in the person's language. */
    protected text<K extends Key>(key: K, ...values: Values<K>): string {
        return this.texts.text(key, ...values);
    }
    protected get texts(): Texts {
        return this.model.texts;
    }
}
