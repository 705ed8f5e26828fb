import { css, html, nothing, type TemplateResult } from 'lit';

import type { ShownProblem } from '../shown_problem.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** What is wrong with clouds and servers, each with what happened, what to do, and the buttons for it. */
export class ProblemList extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            :host {
                display: grid;
                gap: 8px;
            }
            .problem {
                pointer-events: auto;
                padding: 10px 14px 12px;
                background: var(--danger-back);
                border: 1px solid var(--danger);
                border-radius: 10px;
                overflow-wrap: anywhere;
            }
            .retrying,
            .incomplete {
                background: var(--panel-solid);
                border-color: var(--line);
            }
            p {
                margin: 0.2rem 0 0;
            }
            .advice {
                color: var(--muted);
            }
            .ways,
            form {
                display: flex;
                flex-wrap: wrap;
                gap: 0.5rem;
                margin-top: 0.6rem;
            }
            label {
                flex: 1 1 12rem;
            }
            input {
                min-height: 2rem;
            }
        `,
    ];

    override render(): TemplateResult[] {
        return this.model.shownProblems().map((problem) => this.renderProblem(problem));
    }

    private renderProblem(problem: ShownProblem): TemplateResult {
        const { name, kind, sentence, advice } = problem;
        return html`<section
            class="problem ${kind}"
            data-problem=${kind}
            role=${kind === 'stopped' ? 'alert' : 'status'}
            aria-label=${this.text('problem', { name })}
        >
            <strong>${name}</strong>
            <p>${sentence}</p>
            ${advice ? html`<p class="advice" aria-live=${kind === 'retrying' ? 'off' : nothing}>${advice}</p>` : ''}
            ${problem.giveToken ? this.renderToken(problem) : ''}
            <div class="ways">
                ${kind === 'retrying'
                    ? ''
                    : html`<button aria-label=${this.text('problem.retryNamed', { name })} @click=${() => problem.retry()}>
                          ${this.text('problem.retry')}
                      </button>`}
                ${problem.hide
                    ? html`<button aria-label=${this.text('problem.hideNamed', { name })} @click=${() => problem.hide!()}>
                          ${this.text('page.hide')}
                      </button>`
                    : html`<button aria-label=${this.text('problem.closeNamed', { name })} @click=${() => problem.close!()}>
                          ${this.text('problem.close')}
                      </button>`}
            </div>
        </section>`;
    }

    private renderToken({ name, tokenWasRefused, giveToken }: ShownProblem): TemplateResult {
        const give = (event: Event): void => {
            event.preventDefault();
            const field = (event.target as HTMLFormElement).elements.namedItem('token') as HTMLInputElement;
            if (field.value.trim() !== '') giveToken!(field.value);
            field.value = '';
        };
        return html`${tokenWasRefused ? html`<p>${this.text('problem.tokenRefused')}</p>` : ''}
            <form @submit=${give}>
                <label>
                    <input
                        name="token"
                        type="password"
                        autocomplete="off"
                        placeholder=${this.text('problem.token')}
                        aria-label=${this.text('problem.tokenNamed', { name })}
                    />
                </label>
                <button>${this.text('problem.send')}</button>
            </form>
            <p class="advice">${this.text('problem.tokenUse')}</p>`;
    }
}

customElements.define('stipple-problems', ProblemList);
