import { LitElement } from 'lit';

import type { Model } from '../model.ts';
import type { Key, Values } from '../texts/message.ts';
import type { Texts } from '../texts/texts.ts';

/** An element that shows the model, and shows it again when it changed. */
export class ModelElement extends LitElement {
    static override properties = { model: { attribute: false } };
    declare model: Model;

    private readonly refresh = (): void => this.requestUpdate();

    override connectedCallback(): void {
        super.connectedCallback();
        this.model.addEventListener('change', this.refresh);
    }
    override disconnectedCallback(): void {
        this.model.removeEventListener('change', this.refresh);
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
