import { html, type TemplateResult } from 'lit';

import type { Model } from '../model.ts';

/** A link to a file that a server makes; `name`: without its ending, which is the format's. */
export function servedLink(model: Model, href: string, format: string, name: string, title = ''): TemplateResult {
    const save = (event: Event): void => {
        event.preventDefault();
        import('../served_files.ts').then(
            ({ saveServed }) => saveServed(model, href, `${name.replace(/\.stipple$/, '')}.${format}`),
            (error: unknown) => model.tell(error),
        );
    };
    return html`<a href=${href} download title=${title} @click=${save}>${format.toUpperCase()}</a>`;
}
