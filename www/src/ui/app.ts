import './annotation_overlay.ts';
import './control_panel.ts';
import './legend_overlay.ts';
import './loading_bar.ts';
import './notice_list.ts';
import './status_line.ts';

import { html, type TemplateResult } from 'lit';

import { appLayout } from './app_layout.ts';
import type { ControlPanel } from './control_panel.ts';
import { Later } from './later.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

/** Everything over the canvas: the panels, the counters, the status line, notices. */
export class App extends ModelElement {
    static override properties = {
        ...ModelElement.properties,
        countersAreOpen: { state: true },
        helpIsOpen: { state: true },
        isDropTarget: { attribute: false },
        hasControls: { attribute: false },
    };
    declare countersAreOpen: boolean;
    declare helpIsOpen: boolean;
    declare isDropTarget: boolean;
    declare hasControls: boolean;

    static override styles = [controlStyles, appLayout];

    private readonly later = new Later(this);
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

    constructor() {
        super();
        this.countersAreOpen = false;
        this.helpIsOpen = false;
        this.isDropTarget = false;
        this.hasControls = true;
        this.addEventListener('keydown', this.escape);
    }
    override connectedCallback(): void {
        super.connectedCallback();
        this.model.canvas.addEventListener('keydown', this.ask);
    }
    override disconnectedCallback(): void {
        this.model.canvas.removeEventListener('keydown', this.ask);
        super.disconnectedCallback();
    }
    protected override sources(): EventTarget[] {
        return [this.model.profile, this.model.measuring];
    }

    override render(): TemplateResult {
        const { model } = this;
        return html`<stipple-annotation-overlay .model=${model}></stipple-annotation-overlay>
            ${model.clipping.isInUse && this.later.has('clips', () => import('./clip_overlay.ts'))
                ? html`<stipple-clip-overlay .model=${model}></stipple-clip-overlay>`
                : ''}
            ${model.measuring.items.length > 0 && this.later.has('measured', () => import('./measure_overlay.ts'))
                ? html`<stipple-measure-overlay .model=${model}></stipple-measure-overlay>`
                : ''}
            <stipple-loading .model=${model}></stipple-loading>
            ${this.hasControls ? this.renderPanels() : ''}
            <stipple-notices class="notices" .model=${model}></stipple-notices>
            ${this.isDropTarget ? html`<div class="drop">${this.text('page.drop')}</div>` : ''}`;
    }

    private renderPanels(): TemplateResult {
        const { model } = this;
        return html`<stipple-controls
                class="panel controls"
                role="region"
                aria-label=${this.text('page.controls')}
                .model=${model}
                @help=${() => (this.helpIsOpen = true)}
            ></stipple-controls>
            ${this.renderCounters()} ${this.renderPoint()} ${this.renderMap()} ${this.renderProfile()}
            <stipple-legend class="legend" .model=${model}></stipple-legend>
            <stipple-status
                class="status"
                .model=${model}
                .countersAreOpen=${this.countersAreOpen}
                @counters=${() => (this.countersAreOpen = !this.countersAreOpen)}
            ></stipple-status>
            ${this.renderHelp()}`;
    }

    private renderCounters(): TemplateResult | string {
        if (!this.countersAreOpen || !this.later.has('counters', () => import('./counters_panel.ts'))) return '';
        return html`<aside class="panel counters" tabindex="0" aria-label=${this.text('counters')}>
            <stipple-counters .model=${this.model}></stipple-counters>
        </aside>`;
    }
    private renderPoint(): TemplateResult | string {
        if (!this.model.picking.point || !this.later.has('point', () => import('./point_panel.ts'))) return '';
        return html`<aside class="panel point" aria-label=${this.text('point')} aria-live="polite">
            <stipple-point .model=${this.model}></stipple-point>
        </aside>`;
    }
    private renderMap(): TemplateResult | string {
        if (!this.model.isMapOpen || !this.later.has('map', () => import('./map_panel.ts'))) return '';
        return html`<aside class="panel map" aria-label=${this.text('map')}>
            <stipple-map .model=${this.model}></stipple-map>
        </aside>`;
    }
    private renderProfile(): TemplateResult | string {
        if (!this.model.profile.isOpen || !this.later.has('profile', () => import('./profile_panel.ts'))) return '';
        return html`<aside class="panel profile" aria-label=${this.text('profile')}>
            <stipple-profile .model=${this.model}></stipple-profile>
        </aside>`;
    }
    private renderHelp(): TemplateResult | string {
        if (!this.helpIsOpen || !this.later.has('help', () => import('./help_panel.ts'))) return '';
        return html`<div class="panel help" role="dialog" aria-label=${this.text('help')}>
            <stipple-help .model=${this.model} @close=${() => this.closeHelp()}></stipple-help>
        </div>`;
    }

    private closeHelp(): void {
        this.helpIsOpen = false;
        this.renderRoot.querySelector<ControlPanel>('stipple-controls')?.focusHelp();
    }
}

customElements.define('stipple-app', App);
