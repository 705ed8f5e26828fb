import { css, html, type TemplateResult } from 'lit';

import type { Annotation } from '../annotations/annotation.ts';
import { select } from './fields.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** The annotations as a tree; the one that is open can be edited. */
export class AnnotationPanel extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            .add {
                width: 100%;
            }
            .add[aria-pressed='true'] {
                background: var(--accent);
                color: var(--accent-ink);
            }
            ul {
                list-style: none;
                margin: 0.4rem 0 0;
                padding: 0;
            }
            ul ul {
                margin: 0;
                margin-inline-start: 0.9rem;
            }
            .head {
                display: grid;
                grid-template-columns: 1fr auto auto;
                align-items: center;
                gap: 0.2rem;
            }
            .head button {
                background: none;
                border-color: transparent;
                min-height: 1.75rem;
                padding: 0 0.35rem;
            }
            .title {
                text-align: start;
                overflow: hidden;
                text-overflow: ellipsis;
            }
            .title[aria-expanded='true'] {
                color: var(--accent);
            }
            .edit {
                border: 1px solid var(--line);
                border-radius: 8px;
                padding: 0.5rem;
                margin: 0.2rem 0 0.4rem;
                display: grid;
                gap: 0.4rem;
            }
            .ways {
                display: flex;
                flex-wrap: wrap;
                gap: 0.3rem;
            }
            .ways button {
                min-height: 1.75rem;
                font-size: 0.82rem;
                padding: 0 0.5rem;
            }
        `,
    ];

    protected override sources(): EventTarget[] {
        return [this.model.annotations];
    }

    override render(): TemplateResult {
        const { annotations } = this.model;
        return html`<fieldset>
            <legend>${this.text('annotations')}</legend>
            <button class="add" aria-pressed=${annotations.isPlacing} @click=${() => this.place()}>
                ${this.text(annotations.isPlacing ? 'annotations.placing' : 'annotations.new')}
            </button>
            ${annotations.items.length > 1
                ? html`<button class="add" @click=${() => (annotations.isTouring ? annotations.endTour() : void annotations.tour())}>
                      ${this.text(annotations.isTouring ? 'annotations.endTour' : 'annotations.tour')}
                  </button>`
                : ''}
            ${this.renderList(0)}
        </fieldset>`;
    }

    private place(): void {
        this.model.annotations.place();
        this.model.canvas.focus({ preventScroll: true });
    }

    private renderList(parent: number): TemplateResult | string {
        const items = this.model.annotations.childrenOf(parent);
        return items.length > 0 ? html`<ul>${items.map((item) => this.renderItem(item))}</ul>` : '';
    }

    private renderItem(item: Annotation): TemplateResult {
        const { annotations } = this.model, isOpen = annotations.opened === item.id;
        return html`<li data-annotation=${item.id}>
            <div class="head">
                <button class="title" aria-expanded=${isOpen} @click=${() => annotations.open(item.id)}>${item.title}</button>
                <button
                    aria-pressed=${item.hidden}
                    aria-label=${this.text('annotations.hide', { title: item.title })}
                    @click=${() => annotations.change(item.id, { hidden: !item.hidden })}
                >
                    ${item.hidden ? '◌' : '●'}
                </button>
                <button
                    aria-label=${this.text('annotations.flyTo', { title: item.title })}
                    @click=${() => void annotations.flyTo(item.id)}
                >
                    →
                </button>
            </div>
            ${isOpen ? this.renderEditor(item) : ''} ${this.renderList(item.id)}
        </li>`;
    }

    private renderEditor(item: Annotation): TemplateResult {
        const { annotations } = this.model;
        const value = (event: Event): string => (event.target as HTMLInputElement).value;
        const others = annotations.items.filter((other) => other.id !== item.id);
        return html`<div class="edit">
            <input
                aria-label=${this.text('annotations.title')}
                .value=${item.title}
                @change=${(event: Event) => annotations.change(item.id, { title: value(event).trim() || item.title })}
            />
            <textarea
                aria-label=${this.text('annotations.text')}
                rows="4"
                placeholder=${this.text('annotations.textHint')}
                .value=${item.text}
                @change=${(event: Event) => annotations.change(item.id, { text: value(event) })}
            ></textarea>
            ${select(
                this.text('annotations.parent'),
                String(item.parent),
                [['0', this.text('annotations.noParent')], ...others.map(({ id, title }): [string, string] => [String(id), title])],
                (parent) => annotations.change(item.id, { parent: Number(parent) }),
            )}
            <label class="row">
                <span>${this.text('annotations.upTo')}</span>
                <input
                    type="number"
                    min="0"
                    step="any"
                    placeholder=${this.text('annotations.anyDistance')}
                    aria-label=${this.text('annotations.upToLabel')}
                    .value=${item.maxDistance > 0 ? String(item.maxDistance) : ''}
                    @change=${(event: Event) =>
                        annotations.change(item.id, { maxDistance: Math.max(0, Number(value(event)) || 0) })}
                />
            </label>
            <div class="ways">
                <button @click=${() => annotations.keepView(item.id)}>
                    ${this.text(item.camera ? 'annotations.keepViewInstead' : 'annotations.keepView')}
                </button>
                <button @click=${() => annotations.remove(item.id)}>${this.text('annotations.delete')}</button>
            </div>
        </div>`;
    }
}

customElements.define('stipple-annotations', AnnotationPanel);
