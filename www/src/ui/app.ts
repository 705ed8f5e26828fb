import './annotation_overlay.ts';
import './annotation_panel.ts';
import './clip_overlay.ts';
import './clip_panel.ts';
import './cloud_list.ts';
import './film_panel.ts';
import './legend_overlay.ts';
import './look_panel.ts';
import './measure_overlay.ts';
import './measure_panel.ts';
import './problem_list.ts';
import './scene_panel.ts';

import { css, html, type TemplateResult } from 'lit';

import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** Up to this width of the viewer panels are a sheet at its foot, closed at first. */
const narrow = 600;

/** Everything over the canvas: the panel, the counters, the status line, notices. */
export class App extends ModelElement {
    static override properties = {
        ...ModelElement.properties,
        panelIsOpen: { state: true },
        countersAreOpen: { state: true },
        helpIsOpen: { state: true },
        isDropTarget: { attribute: false },
        hasControls: { attribute: false },
    };
    declare panelIsOpen: boolean;
    declare countersAreOpen: boolean;
    declare helpIsOpen: boolean;
    declare isDropTarget: boolean;
    declare hasControls: boolean;

    static override styles = [
        controlStyles,
        css`
            :host {
                position: absolute;
                inset: 0;
                isolation: isolate;
                pointer-events: none;
                display: grid;
                grid-template-columns: auto 1fr auto;
                grid-template-rows: 1fr auto auto;
                padding: 12px;
                gap: 12px;
            }
            :host > :not(stipple-measure-overlay, stipple-clip-overlay, stipple-annotation-overlay) {
                pointer-events: auto;
            }
            .panel {
                background: var(--panel);
                border: 1px solid var(--line);
                border-radius: 12px;
                padding: 14px;
                max-height: 100%;
                overflow-y: auto;
                overscroll-behavior: contain;
                align-self: start;
                scrollbar-width: thin;
            }
            .controls {
                grid-row: 1 / 4;
                width: 296px;
            }
            .controls.closed {
                width: auto;
                padding: 8px 10px;
            }
            .body {
                display: grid;
                gap: 1.3rem;
                margin-top: 1rem;
            }
            header {
                display: flex;
                align-items: center;
                justify-content: space-between;
                gap: 0.8rem;
            }
            h1 {
                margin: 0;
                font-size: 1.05rem;
                font-weight: 650;
                letter-spacing: 0.01em;
            }
            .ask {
                margin-inline-start: auto;
            }
            .quiet {
                background: none;
                border-color: transparent;
                color: var(--muted);
                padding: 0 0.5rem;
            }
            .counters {
                grid-column: 3;
                grid-row: 1;
                width: 250px;
            }
            .point {
                grid-column: 2;
                grid-row: 1;
                justify-self: end;
                align-self: end;
                width: 270px;
            }
            .help {
                position: absolute;
                inset: 12px;
                width: fit-content;
                max-width: min(46rem, 100% - 24px);
                height: fit-content;
                max-height: calc(100% - 24px);
                margin: auto;
                z-index: 1;
                background: var(--panel-solid);
            }
            .map {
                grid-column: 3;
                grid-row: 1;
                align-self: end;
                width: 330px;
                max-width: 100%;
            }
            .profile {
                grid-column: 2 / 4;
                grid-row: 2;
                align-self: end;
                min-width: 0;
            }
            .legend {
                grid-column: 2;
                grid-row: 3;
                justify-self: start;
                align-self: end;
                pointer-events: none !important;
            }
            .status {
                grid-column: 2 / 4;
                grid-row: 3;
                justify-self: end;
                align-self: end;
                display: flex;
                align-items: center;
                gap: 0.4rem;
                padding: 2px 4px 2px 12px;
                background: var(--panel);
                border: 1px solid var(--line);
                border-radius: 999px;
                font-size: 0.85rem;
                font-variant-numeric: tabular-nums;
                color: var(--muted);
                white-space: nowrap;
            }
            .status span {
                unicode-bidi: plaintext;
            }
            .status button {
                border-radius: 999px;
                min-height: 1.75rem;
            }
            progress {
                appearance: none;
                position: absolute;
                inset: 0 0 auto 0;
                width: 100%;
                height: 3px;
                border: 0;
                background: none;
                pointer-events: none;
            }
            progress::-webkit-progress-bar {
                background: none;
            }
            progress::-webkit-progress-value {
                background: var(--accent);
                transition: width 150ms;
            }
            progress::-moz-progress-bar {
                background: var(--accent);
            }
            .notices {
                position: absolute;
                inset: 12px 0 auto;
                margin-inline: auto;
                width: min(520px, 100% - 24px);
                display: grid;
                gap: 8px;
                pointer-events: none;
            }
            .notice {
                pointer-events: auto;
                display: grid;
                grid-template-columns: 1fr auto;
                gap: 0.6rem;
                align-items: start;
                padding: 10px 8px 10px 14px;
                background: var(--danger-back);
                border: 1px solid var(--danger);
                border-radius: 10px;
                overflow-wrap: anywhere;
            }
            .drop {
                position: absolute;
                inset: 12px;
                display: grid;
                place-items: center;
                border: 2px dashed var(--accent);
                border-radius: 16px;
                background: var(--panel);
                font-size: 1.2rem;
                pointer-events: none;
            }
            @container (max-width: 600px) {
                :host {
                    grid-template-columns: 1fr;
                    grid-template-rows: 1fr auto auto;
                    padding: 8px;
                    gap: 8px;
                }
                .controls {
                    grid-row: 3;
                    grid-column: 1;
                    width: 100%;
                    max-height: 52cqh;
                    align-self: end;
                }
                .controls.closed {
                    width: 100%;
                }
                .counters {
                    grid-column: 1;
                    grid-row: 1;
                    justify-self: end;
                    max-height: 40cqh;
                }
                .point {
                    grid-column: 1;
                    grid-row: 1;
                    justify-self: start;
                    max-height: 40cqh;
                }
                .profile,
                .map {
                    grid-column: 1;
                    grid-row: 1;
                }
                .map {
                    width: 100%;
                    align-self: start;
                }
                /* One at a time. */
                .counters:has(~ .point, ~ .profile),
                .point ~ .profile {
                    display: none;
                }
                .status {
                    grid-column: 1;
                    grid-row: 2;
                    align-self: end;
                }
                .legend {
                    grid-column: 1;
                    grid-row: 1;
                    align-self: end;
                }
            }
            @media (prefers-reduced-motion: reduce) {
                * {
                    transition: none !important;
                }
            }
        `,
    ];

    /** Of the panels that are loaded later. */
    private readonly loaded = new Set<string>();
    private readonly follow = (): void => this.requestUpdate();
    private readonly ask = (event: KeyboardEvent): void => {
        if (event.key === '?' && this.hasControls) this.helpIsOpen = true;
    };
    /** Escape lets go of what is in hand, from every panel, and goes back to the picture. */
    private readonly escape = (event: KeyboardEvent): void => {
        if (event.key !== 'Escape' || event.defaultPrevented) return;
        if (this.helpIsOpen) return this.closeHelp();
        this.model.letGo();
        this.model.canvas.focus({ preventScroll: true });
    };

    override connectedCallback(): void {
        super.connectedCallback();
        this.model.profile.addEventListener('change', this.follow);
        this.addEventListener('keydown', this.escape);
        this.model.canvas.addEventListener('keydown', this.ask);
        this.panelIsOpen = this.model.canvas.clientWidth > narrow;
    }
    override disconnectedCallback(): void {
        this.model.canvas.removeEventListener('keydown', this.ask);
        this.model.profile.removeEventListener('change', this.follow);
        super.disconnectedCallback();
    }

    constructor() {
        super();
        this.panelIsOpen = true;
        this.countersAreOpen = false;
        this.helpIsOpen = false;
        this.isDropTarget = false;
        this.hasControls = true;
    }

    override render(): TemplateResult {
        return html`<stipple-annotation-overlay .model=${this.model}></stipple-annotation-overlay>
            <stipple-clip-overlay .model=${this.model}></stipple-clip-overlay>
            <stipple-measure-overlay .model=${this.model}></stipple-measure-overlay>
            ${this.renderProgress()} ${this.hasControls ? this.renderPanels() : ''}
            ${this.renderNotices()}
            ${this.isDropTarget ? html`<div class="drop">${this.text('page.drop')}</div>` : ''}`;
    }

    private renderPanels(): TemplateResult {
        return html`${this.renderControls()}
            ${this.countersAreOpen && this.has('counters', () => import('./counters_panel.ts'))
                ? html`<aside class="panel counters" tabindex="0" aria-label=${this.text('counters')}>
                      <stipple-counters .model=${this.model}></stipple-counters>
                  </aside>`
                : ''}
            ${this.model.picking.point && this.has('point', () => import('./point_panel.ts'))
                ? html`<aside class="panel point" aria-label=${this.text('point')} aria-live="polite">
                      <stipple-point .model=${this.model}></stipple-point>
                  </aside>`
                : ''}
            ${this.model.isMapOpen && this.has('map', () => import('./map_panel.ts'))
                ? html`<aside class="panel map" aria-label=${this.text('map')}>
                      <stipple-map .model=${this.model}></stipple-map>
                  </aside>`
                : ''}
            ${this.model.profile.isOpen && this.has('profile', () => import('./profile_panel.ts'))
                ? html`<aside class="panel profile" aria-label=${this.text('profile')}>
                      <stipple-profile .model=${this.model}></stipple-profile>
                  </aside>`
                : ''}
            <stipple-legend class="legend" .model=${this.model}></stipple-legend>
            ${this.renderStatus()}
            ${this.helpIsOpen && this.has('help', () => import('./help_panel.ts'))
                ? html`<div class="panel help" role="dialog" aria-label=${this.text('help')}>
                      <stipple-help .model=${this.model} @close=${() => this.closeHelp()}></stipple-help>
                  </div>`
                : ''}`;
    }

    /** Whether a panel is here: panels that few want at first are loaded when they are asked for. */
    private has(panel: string, load: () => Promise<unknown>): boolean {
        if (!this.loaded.has(panel))
            load().then(
                () => {
                    this.loaded.add(panel);
                    this.requestUpdate();
                },
                (error: unknown) => this.model.tell(error),
            );
        return this.loaded.has(panel);
    }
    private closeHelp(): void {
        this.helpIsOpen = false;
        this.renderRoot.querySelector<HTMLElement>('.ask')?.focus();
    }

    private renderNotices(): TemplateResult {
        return html`<div class="notices">
                ${this.model.isContextLost
                    ? html`<div class="notice" role="alert"><span>${this.text('page.contextLost')}</span></div>`
                    : ''}
                <stipple-problems .model=${this.model}></stipple-problems>
                ${this.model.notices.map(
                    (notice) =>
                        html`<div class="notice" role="alert">
                            <span>${notice}</span>
                            <button
                                class="quiet"
                                aria-label=${this.text('page.dismiss')}
                                @click=${() => this.model.dismiss(notice)}
                            >
                                ✕
                            </button>
                        </div>`,
                )}
            </div>`;
    }

    private renderControls(): TemplateResult {
        return html`<section class="panel controls ${this.panelIsOpen ? '' : 'closed'}" aria-label=${this.text('page.controls')}>
            <header>
                <h1>Stipple</h1>
                <button
                    class="quiet ask"
                    aria-label=${this.text('help')}
                    aria-haspopup="dialog"
                    @click=${() => (this.helpIsOpen = true)}
                >
                    ?
                </button>
                <button
                    class="quiet"
                    aria-expanded=${this.panelIsOpen}
                    aria-controls="body"
                    @click=${() => (this.panelIsOpen = !this.panelIsOpen)}
                >
                    ${this.text(this.panelIsOpen ? 'page.hide' : 'page.controls')}
                </button>
            </header>
            <div class="body" id="body" ?hidden=${!this.panelIsOpen}>
                <stipple-clouds .model=${this.model}></stipple-clouds>
                <stipple-measure .model=${this.model}></stipple-measure>
                <stipple-clip .model=${this.model}></stipple-clip>
                <stipple-annotations .model=${this.model}></stipple-annotations>
                <stipple-look .model=${this.model}></stipple-look>
                <stipple-film .model=${this.model}></stipple-film>
                <stipple-scene .model=${this.model}></stipple-scene>
            </div>
        </section>`;
    }

    private renderStatus(): TemplateResult {
        const { frame, session } = this.model.counters, drawn = Number(frame['pointsDrawn']);
        return html`<div class="status">
            <span>${this.text('page.points', { count: drawn, shown: this.texts.compact(drawn) })}</span>
            <span aria-hidden="true">·</span>
            <span>${this.text('page.fetched', { bytes: this.texts.bytes(session['bytesReceived']!) })}</span>
            <button
                class="quiet"
                aria-expanded=${this.countersAreOpen}
                @click=${() => (this.countersAreOpen = !this.countersAreOpen)}
            >
                ${this.text('counters')}
            </button>
        </div>`;
    }

    /** How much of what the picture wants is drawn; gone when all is. */
    private renderProgress(): TemplateResult | string {
        const { frame, settled } = this.model.counters;
        if (settled) return '';
        const wanted = Math.max(1, Number(frame['nodesSelected']));
        return html`<progress
            aria-label=${this.text('page.loading')}
            max=${wanted}
            .value=${Number(frame['nodesDrawn'])}
        ></progress>`;
    }
}

customElements.define('stipple-app', App);
