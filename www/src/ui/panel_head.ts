import { html, type TemplateResult } from 'lit';

/** A panel's title, what else stands beside it, and the cross that closes it; with `headStyles`. */
export function panelHead(title: string, closeLabel: string, close: () => void, beside: TemplateResult | string = ''): TemplateResult {
    return html`<header>
        <h2>${title}</h2>
        ${beside}
        <button class="quiet" aria-label=${closeLabel} @click=${close}>✕</button>
    </header>`;
}
