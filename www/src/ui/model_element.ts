import { LitElement } from 'lit';

import type { Model } from '../model.ts';

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
}

const count = new Intl.NumberFormat('en', { maximumFractionDigits: 0 });
const compact = new Intl.NumberFormat('en', { notation: 'compact', maximumSignificantDigits: 3 });

export function formatCount(value: number): string {
    return count.format(value);
}
export function formatCompact(value: number): string {
    return compact.format(value);
}
export function formatBytes(value: number): string {
    const units = ['B', 'KiB', 'MiB', 'GiB', 'TiB'];
    let unit = 0;
    while (value >= 1024 && unit < units.length - 1) {
        value /= 1024;
        unit++;
    }
    return `${value >= 100 || unit === 0 ? value.toFixed(0) : value.toFixed(1)} ${units[unit]}`;
}
