import { css, html, type TemplateResult } from 'lit';

import type { Annotation } from '../annotations/annotation.ts';
import { OverlayElement } from './overlay_element.ts';

/** Labels of annotations over the picture; the one that is opened shows its text. Fainter behind something. */
export class AnnotationOverlay extends OverlayElement {
    static override styles = [
        OverlayElement.overlayStyles,
        css`
            .label {
                position: absolute;
                transform: translate(-50%, calc(-100% - 9px));
                pointer-events: auto;
                font: inherit;
                font-size: 0.85rem;
                color: var(--text);
                background: var(--panel);
                border: 1px solid var(--line);
                border-radius: 999px;
                padding: 0.15rem 0.7rem;
                min-height: 24px;
                cursor: pointer;
                max-width: 14rem;
                overflow: hidden;
                text-overflow: ellipsis;
                white-space: nowrap;
            }
            .label.covered {
                opacity: 0.35;
            }
            .label.aside {
                pointer-events: none;
            }
            .label.open {
                border-color: var(--accent);
            }
            .dot {
                position: absolute;
                width: 8px;
                height: 8px;
                border-radius: 50%;
                background: var(--accent);
                border: 1px solid var(--panel-solid);
                transform: translate(-50%, -50%);
            }
            .text {
                position: absolute;
                transform: translate(-50%, 10px);
                pointer-events: auto;
                width: max-content;
                max-width: 20rem;
                max-height: 14rem;
                overflow: auto;
                background: var(--panel);
                border: 1px solid var(--line);
                border-radius: 10px;
                padding: 0.5rem 0.8rem;
                font-size: 0.85rem;
                user-select: text;
                overflow-wrap: anywhere;
            }
            .text > div > :first-child {
                margin-top: 0;
            }
            .text > div > :last-child {
                margin-bottom: 0;
            }
            .text a {
                color: var(--accent);
            }
            .text img {
                max-width: 100%;
            }
        `,
    ];

    private readonly rest = (): void => void this.model.annotations.look();
    /** Of the text that is open. */
    private rendered: { text: string; content: Element | string } = { text: '', content: '' };

    override connectedCallback(): void {
        super.connectedCallback();
        for (const event of ['rest', 'settled']) this.model.addEventListener(event, this.rest);
    }
    override disconnectedCallback(): void {
        for (const event of ['rest', 'settled']) this.model.removeEventListener(event, this.rest);
        super.disconnectedCallback();
    }
    protected override sources(): EventTarget[] {
        return [this.model.annotations, this.model.measuring];
    }

    override render(): TemplateResult | string {
        const { annotations } = this.model;
        const shown = annotations.items.filter((item) => annotations.isShown(item));
        if (shown.length === 0) return '';
        const places = this.model.surface.project(shown.map((item) => item.position));
        return html`${shown.map((item, i) => (this.isSeen(places[i]) ? this.renderItem(item, places[i]!) : ''))}`;
    }

    /** The Tab key goes to no label that is out of the picture. */
    private isSeen(place: { x: number; y: number } | null | undefined): boolean {
        const { clientWidth, clientHeight } = this.model.canvas;
        return !!place && place.x >= 0 && place.y >= 0 && place.x <= clientWidth && place.y <= clientHeight;
    }

    private renderItem(item: Annotation, { x, y }: { x: number; y: number }): TemplateResult {
        const { annotations } = this.model;
        // While a tool is in hand, clicks are for points of the cloud.
        const isFree = !annotations.isPlacing && !this.model.measuring.isDrawing;
        const isOpen = isFree && annotations.opened === item.id, place = `left: ${x}px; top: ${y}px`;
        const covered = annotations.covered.has(item.id) && !isOpen ? 'covered' : '';
        return html`<span class="dot" .style=${place}></span>
            <button
                class="label ${covered} ${isOpen ? 'open' : ''} ${isFree ? '' : 'aside'}"
                .style=${place}
                aria-expanded=${isOpen}
                @click=${() => annotations.open(item.id)}
                @dblclick=${() => void annotations.flyTo(item.id)}
            >
                ${item.title}
            </button>
            ${isOpen && item.text ? html`<div class="text" .style=${place}>${this.contentOf(item.text)}</div>` : ''}`;
    }

    /** Markdown is read by a part of the page that is loaded when it is wanted first. */
    private contentOf(text: string): Element | string {
        if (this.rendered.text !== text) {
            this.rendered = { text, content: '' };
            void import('../annotations/markdown.ts').then(({ renderMarkdown }) => {
                if (this.rendered.text !== text) return;
                const content = document.createElement('div');
                content.append(renderMarkdown(text));
                this.rendered = { text, content };
                this.requestUpdate();
            });
        }
        return this.rendered.content;
    }
}

customElements.define('stipple-annotation-overlay', AnnotationOverlay);
