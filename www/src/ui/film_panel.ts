import { css, html, type TemplateResult } from 'lit';

import type { Film } from '../navigation/film.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** The camera path: its keyframes, playing it, and its pictures as files. */
export class FilmPanel extends ModelElement {
    static override properties = { ...ModelElement.properties, framesPerSecond: { state: true } };
    declare framesPerSecond: number;

    static override styles = [
        controlStyles,
        css`
            .ways {
                display: flex;
                flex-wrap: wrap;
                gap: 0.4rem;
            }
            .ways button {
                padding: 0 0.5rem;
                font-size: 0.9rem;
            }
            ol {
                list-style: none;
                margin: 0.5rem 0 0;
                padding: 0;
                display: grid;
                gap: 0.2rem;
            }
            li {
                display: grid;
                grid-template-columns: 1fr auto auto auto auto;
                align-items: center;
                gap: 0.2rem;
            }
            li button {
                background: none;
                border-color: transparent;
                min-height: 1.75rem;
                padding: 0 0.35rem;
            }
            li .name {
                text-align: start;
            }
            input[type='number'] {
                width: 4.2rem;
            }
            .seek {
                margin-top: 0.4rem;
            }
            .hint {
                margin: 0.4rem 0 0;
                font-size: 0.82rem;
                color: var(--muted);
            }
        `,
    ];

    constructor() {
        super();
        this.framesPerSecond = 25;
    }
    protected override sources(): EventTarget[] {
        return [this.film];
    }
    private get film(): Film {
        return this.model.film;
    }

    override render(): TemplateResult {
        const { film } = this;
        return html`<fieldset>
            <legend>${this.text('film')}</legend>
            <div class="ways">
                <button ?disabled=${film.progress !== undefined} @click=${() => film.add()}>${this.text('film.add')}</button>
                ${film.keyframes.length > 1 ? this.renderPlay() : ''}
            </div>
            ${film.keyframes.length === 0 ? html`<p class="hint">${this.text('film.hint')}</p>` : ''}
            <ol>
                ${film.keyframes.map((_, index) => this.renderKeyframe(index))}
            </ol>
            ${film.keyframes.length > 1 ? this.renderTimes() : ''}
        </fieldset>`;
    }

    private renderPlay(): TemplateResult {
        const { film } = this;
        return film.isPlaying
            ? html`<button @click=${() => film.stop()}>${this.text('film.stop')}</button>`
            : html`<button ?disabled=${film.progress !== undefined} @click=${() => film.play()}>${this.text('film.play')}</button>`;
    }

    private renderKeyframe(index: number): TemplateResult {
        const { film } = this, name = this.text('film.keyframe', { number: index + 1 });
        return html`<li data-keyframe=${index}>
            <button class="name" @click=${() => film.show(index)}>${name}</button>
            ${index === 0
                ? html`<span></span>`
                : html`<input
                      type="number"
                      min="0.1"
                      max="3600"
                      step="0.1"
                      aria-label=${this.text('film.seconds', { name })}
                      .value=${String(film.keyframes[index]!.seconds)}
                      @change=${(event: Event) => film.setSeconds(index, Number((event.target as HTMLInputElement).value))}
                  />`}
            <button aria-label=${this.text('film.up', { name })} ?disabled=${index === 0} @click=${() => film.moveUp(index)}>↑</button>
            <button aria-label=${this.text('film.retake', { name })} @click=${() => film.retake(index)}>◉</button>
            <button aria-label=${this.text('film.remove', { name })} @click=${() => film.remove(index)}>✕</button>
        </li>`;
    }

    private renderTimes(): TemplateResult {
        const { film } = this, at = this.texts.decimals(film.time, 1), of = this.texts.decimals(film.duration, 1);
        return html`<label class="row seek">
                <span>${this.text('film.time')}</span>
                <span class="value">
                    <input
                        type="range"
                        min="0"
                        max=${film.duration}
                        step="any"
                        aria-label=${this.text('film.time')}
                        aria-valuetext=${this.text('film.timeOf', { at, of })}
                        .value=${String(film.time)}
                        @input=${(event: Event) => film.seek(Number((event.target as HTMLInputElement).value))}
                    />
                    <output aria-hidden="true">${at} / ${of}</output>
                </span>
            </label>
            <label class="row">
                <span>${this.text('film.rate')}</span>
                <input
                    type="number"
                    min="1"
                    max="120"
                    .value=${String(this.framesPerSecond)}
                    @change=${(event: Event) => (this.framesPerSecond = Number((event.target as HTMLInputElement).value))}
                />
            </label>
            <div class="ways">
                ${film.progress
                    ? html`<button @click=${() => film.stop()}>
                          ${this.text('film.giveUp', { done: film.progress.done, of: film.progress.of })}
                      </button>`
                    : html`<button @click=${() => void this.write()}>${this.text('film.write')}</button>`}
            </div>`;
    }

    private async write(): Promise<void> {
        const { width, height } = this.model.pictureSize();
        try {
            await this.film.write({ width, height, framesPerSecond: this.framesPerSecond });
        } catch (error) {
            this.model.tell(error);
        }
    }
}

customElements.define('stipple-film', FilmPanel);
