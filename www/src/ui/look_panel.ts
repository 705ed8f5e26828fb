import './colour_panel.ts';

import { css, html, type TemplateResult } from 'lit';

import type { Quality } from '../looks/looks.ts';
import { choice, slider } from './fields.ts';
import { ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';
import { followToolbarKeys, keepToolbarStop, stopOf } from './toolbar.ts';


/** How the clouds are looked at: view, points, colour, light. */
export class LookPanel extends ModelElement {
    static override styles = [
        controlStyles,
        css`
            :host {
                display: grid;
                gap: 1.3rem;
            }
            .views {
                display: grid;
                grid-template-columns: repeat(4, 1fr);
                gap: 0.4rem;
            }
            .hint {
                margin: 0.4rem 0 0;
                font-size: 0.82rem;
                color: var(--muted);
            }
            .views button {
                padding: 0 0.2rem;
            }
        `,
    ];

    override render(): TemplateResult {
        return html`${this.renderView()} ${this.renderPoints()} <stipple-colour .model=${this.model}></stipple-colour> ${this.renderLight()}`;
    }

    private renderView(): TemplateResult {
        const { model } = this;
        return html`<fieldset>
            <legend>${this.text('view')}</legend>
            <div
                class="views"
                role="toolbar"
                aria-label=${this.text('view')}
                @keydown=${followToolbarKeys}
                @focusin=${keepToolbarStop}
            >
                <button tabindex=${stopOf(0)} @click=${() => model.camera.showView('top')}>${this.text('view.top')}</button>
                <button tabindex=${stopOf(1)} @click=${() => model.camera.showView('front')}>${this.text('view.front')}</button>
                <button tabindex=${stopOf(2)} @click=${() => model.camera.showView('side')}>${this.text('view.side')}</button>
                <button tabindex=${stopOf(3)} @click=${() => model.camera.showView('iso')}>${this.text('view.iso')}</button>
                <button tabindex=${stopOf(4)} title=${this.text('view.allHint')} @click=${() => void model.camera.flyToCloud()}>${this.text('view.all')}</button>
                <button tabindex=${stopOf(5)}
                    title=${this.text('view.backHint')}
                    ?disabled=${!model.camera.history.canGoBack}
                    @click=${() => model.camera.back()}
                >
                    ${this.text('view.back')}
                </button>
                <button tabindex=${stopOf(6)}
                    title=${this.text('view.forthHint')}
                    ?disabled=${!model.camera.history.canGoForward}
                    @click=${() => model.camera.forward()}
                >
                    ${this.text('view.forth')}
                </button>
            </div>
            ${choice(
                this.text('view.move'),
                'navigation',
                model.navigator.mode,
                [
                    ['orbit', this.text('view.orbit')],
                    ['earth', this.text('view.earth')],
                    ['fly', this.text('view.fly')],
                ],
                (mode) => model.setNavigation(mode),
            )}
            ${model.navigator.mode === 'fly'
                ? html`<p class="hint">${this.text('view.flyHint')}</p>`
                : ''}
            ${choice(
                this.text('view.projection'),
                'projection',
                model.projection,
                [
                    ['perspective', this.text('view.perspective')],
                    ['orthographic', this.text('view.orthographic')],
                ],
                (projection) => model.camera.setProjection(projection),
            )}
        </fieldset>`;
    }

    private renderPoints(): TemplateResult {
        const { style, limits } = this.model;
        const isContinuous = style.detail.mode === 'continuous';
        return html`<fieldset>
            <legend>${this.text('points')}</legend>
            ${choice<Quality | ''>(
                this.text('points.quality'),
                'quality',
                this.model.looks.quality() ?? '',
                (['fast', 'balanced', 'fine', 'best'] as const).map((quality) => [quality, this.text(`points.${quality}`)]),
                (quality) => quality && this.model.looks.choose(quality),
            )}
            ${slider(
                this.text('points.budget'),
                limits.pointBudget,
                { min: 1e4, max: 2e7, logarithmic: true, digits: 2 },
                this.texts.compact(limits.pointBudget),
                (pointBudget) => this.model.changeLimits({ pointBudget }),
            )}
            ${slider(
                this.text('points.frameTime'),
                Math.max(limits.frameMilliseconds, 1),
                { min: 1, max: 200, logarithmic: true, digits: 2 },
                limits.frameMilliseconds > 0
                    ? this.text('points.milliseconds', { value: Math.round(limits.frameMilliseconds) })
                    : this.text('points.anyTime'),
                (milliseconds) => this.model.changeLimits({ frameMilliseconds: milliseconds < 2 ? 0 : milliseconds }),
            )}
            ${choice(
                this.text('points.detail'),
                'detail',
                style.detail.mode,
                [
                    ['discrete', this.text('points.levels')],
                    ['continuous', this.text('points.continuous')],
                ],
                (mode) =>
                    this.model.changeStyle({
                        detail: { ...style.detail, mode },
                        // Spacings are of continuous detail alone.
                        ...(mode === 'discrete' && style.sizeMode === 'spacing' ? { sizeMode: 'fixed' } : {}),
                    }),
            )}
            ${isContinuous
                ? slider(
                      this.text('points.spacing'),
                      style.detail.spacingPixels,
                      { min: 0.5, max: 10, logarithmic: true, digits: 2 },
                      this.pixels(style.detail.spacingPixels),
                      (spacingPixels) => this.model.changeStyle({ detail: { ...style.detail, spacingPixels } }),
                  )
                : ''}
            ${choice(
                this.text('points.sizeIn'),
                'size-mode',
                style.sizeMode,
                (['fixed', 'world', 'adaptive', 'spacing'] as const)
                    .filter((mode) => mode !== 'spacing' || isContinuous)
                    .map((mode) => [mode, this.text(mode === 'spacing' ? 'points.spacings' : `points.${mode}`)]),
                (sizeMode) => this.model.changeStyle({ sizeMode }),
            )}
            ${this.renderSize()}
            ${choice(
                this.text('points.shape'),
                'shape',
                style.shape,
                (['circle', 'square', 'paraboloid', 'disc'] as const)
                    .filter((shape) => shape !== 'disc' || this.canDrawDiscs())
                    .map((shape) => [shape, this.text(`points.${shape}`)]),
                (shape) => this.model.changeStyle({ shape }),
            )}
            ${choice(
                this.text('points.expandLate'),
                'delayed-expansion',
                style.delayedExpansion,
                (['off', 'auto', 'on'] as const).map((mode) => [mode, this.text(`points.${mode}`)]),
                (delayedExpansion) => this.model.changeStyle({ delayedExpansion }),
            )}
            <label class="row">
                <span>${this.text('points.blend')}</span>
                <span>
                    <input
                        type="checkbox"
                        aria-label=${this.text('points.splats')}
                        .checked=${style.splats.enabled}
                        @change=${(event: Event) =>
                            this.model.changeStyle({
                                splats: { ...style.splats, enabled: (event.target as HTMLInputElement).checked },
                            })}
                    />
                </span>
            </label>
        </fieldset>`;
    }

    /** Some cloud has normals; or discs are chosen, and the choice must show. */
    private canDrawDiscs(): boolean {
        const { clouds, style } = this.model;
        return style.shape === 'disc' || clouds.some((cloud) => cloud.hasNormals === true);
    }

    private pixels(value: number): string {
        return this.text('points.pixels', { value: this.texts.number(value) });
    }

    private renderSize(): TemplateResult {
        const { style } = this.model;
        switch (style.sizeMode) {
            case 'fixed':
                return slider(
                    this.text('points.size'),
                    style.sizePixels,
                    { min: 1, max: 20, logarithmic: true, digits: 2 },
                    this.pixels(style.sizePixels),
                    (sizePixels) => this.model.changeStyle({ sizePixels }),
                );
            case 'world':
                return slider(
                    this.text('points.size'),
                    style.sizeWorld,
                    { min: 0.001, max: 10, logarithmic: true, digits: 2 },
                    this.texts.number(style.sizeWorld),
                    (sizeWorld) => this.model.changeStyle({ sizeWorld }),
                );
            case 'spacing':
            case 'adaptive':
                return slider(
                    this.text('points.size'),
                    style.sizeSpacings,
                    { min: 0.5, max: 5, logarithmic: true, digits: 2 },
                    `${this.texts.number(style.sizeSpacings)} ×`,
                    (sizeSpacings) => this.model.changeStyle({ sizeSpacings }),
                );
        }
    }

    private renderLight(): TemplateResult {
        const { edl } = this.model.style;
        return html`<fieldset>
            <legend>${this.text('light')}</legend>
            <label class="row">
                <span>${this.text('light.shade')}</span>
                <span>
                    <input
                        type="checkbox"
                        aria-label=${this.text('light')}
                        .checked=${edl.enabled}
                        @change=${(event: Event) =>
                            this.model.changeStyle({
                                edl: { enabled: (event.target as HTMLInputElement).checked },
                            })}
                    />
                </span>
            </label>
            ${slider(
                this.text('light.strength'),
                edl.strength,
                { min: 0, max: 2, digits: 2 },
                this.texts.number(edl.strength),
                (strength) => this.model.changeStyle({ edl: { strength } }),
                !edl.enabled,
            )}
            ${slider(
                this.text('light.radius'),
                edl.radiusPixels,
                { min: 0.5, max: 5, digits: 2 },
                this.pixels(edl.radiusPixels),
                (radiusPixels) => this.model.changeStyle({ edl: { radiusPixels } }),
                !edl.enabled,
            )}
        </fieldset>`;
    }
}

customElements.define('stipple-look', LookPanel);
