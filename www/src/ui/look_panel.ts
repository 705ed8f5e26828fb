import './colour_panel.ts';

import { css, html, type TemplateResult } from 'lit';

import type { Style } from '../wasm/values.ts';
import { choice, slider } from './fields.ts';
import { formatCompact, ModelElement } from './model_element.ts';
import { controlStyles } from './shared_styles.ts';

const spacingSize: [Style['sizeMode'], string] = ['spacing', 'Spacings'];
const discShape: [Style['shape'], string] = ['disc', 'Disc'];

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
            <legend>View</legend>
            <div class="views">
                <button @click=${() => model.camera.showView('top')}>Top</button>
                <button @click=${() => model.camera.showView('front')}>Front</button>
                <button @click=${() => model.camera.showView('side')}>Side</button>
                <button @click=${() => model.camera.showView('iso')}>Iso</button>
                <button title="Show all (F)" @click=${() => void model.camera.flyToCloud()}>All</button>
                <button
                    title="Where the camera was before (U)"
                    ?disabled=${!model.camera.history.canGoBack}
                    @click=${() => model.camera.back()}
                >
                    Back
                </button>
                <button
                    title="Forth again (shift U)"
                    ?disabled=${!model.camera.history.canGoForward}
                    @click=${() => model.camera.forward()}
                >
                    Forth
                </button>
            </div>
            ${choice(
                'Move',
                'navigation',
                model.navigator.mode,
                [
                    ['orbit', 'Orbit'],
                    ['earth', 'Earth'],
                    ['fly', 'Fly'],
                ],
                (mode) => model.setNavigation(mode),
            )}
            ${model.navigator.mode === 'fly'
                ? html`<p class="hint">W, A, S, D walk, E and Q rise and sink; the wheel makes it faster or slower while a key is held.</p>`
                : ''}
            ${choice(
                'Projection',
                'projection',
                model.projection,
                [
                    ['perspective', 'Persp.'],
                    ['orthographic', 'Ortho.'],
                ],
                (projection) => model.camera.setProjection(projection),
            )}
        </fieldset>`;
    }

    private renderPoints(): TemplateResult {
        const { style, limits } = this.model;
        const isContinuous = style.detail.mode === 'continuous';
        return html`<fieldset>
            <legend>Points</legend>
            ${slider(
                'Budget',
                limits.pointBudget,
                { min: 1e4, max: 2e7, logarithmic: true, digits: 2 },
                formatCompact(limits.pointBudget),
                (pointBudget) => this.model.changeLimits({ pointBudget }),
            )}
            ${slider(
                'Frame time',
                Math.max(limits.frameMilliseconds, 1),
                { min: 1, max: 200, logarithmic: true, digits: 2 },
                limits.frameMilliseconds > 0 ? `${Math.round(limits.frameMilliseconds)} ms` : 'any',
                (milliseconds) => this.model.changeLimits({ frameMilliseconds: milliseconds < 2 ? 0 : milliseconds }),
            )}
            ${choice(
                'Detail',
                'detail',
                style.detail.mode,
                [
                    ['discrete', 'Levels'],
                    ['continuous', 'Continuous'],
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
                      'Spacing',
                      style.detail.spacingPixels,
                      { min: 0.5, max: 10, logarithmic: true, digits: 2 },
                      `${style.detail.spacingPixels} px`,
                      (spacingPixels) => this.model.changeStyle({ detail: { ...style.detail, spacingPixels } }),
                  )
                : ''}
            ${choice(
                'Size in',
                'size-mode',
                style.sizeMode,
                [
                    ['fixed', 'Pixels'],
                    ['world', 'World'],
                    ['adaptive', 'Octree'],
                    ...(isContinuous ? [spacingSize] : []),
                ],
                (sizeMode) => this.model.changeStyle({ sizeMode }),
            )}
            ${this.renderSize()}
            ${choice(
                'Shape',
                'shape',
                style.shape,
                [
                    ['circle', 'Circle'],
                    ['square', 'Square'],
                    ['paraboloid', 'Parab.'],
                    ...(this.canDrawDiscs() ? [discShape] : []),
                ],
                (shape) => this.model.changeStyle({ shape }),
            )}
            ${choice(
                'Expand late',
                'delayed-expansion',
                style.delayedExpansion,
                [
                    ['off', 'Off'],
                    ['auto', 'Auto'],
                    ['on', 'On'],
                ],
                (delayedExpansion) => this.model.changeStyle({ delayedExpansion }),
            )}
            <label class="row">
                <span>Blend</span>
                <span>
                    <input
                        type="checkbox"
                        aria-label="High-quality splats"
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

    private renderSize(): TemplateResult {
        const { style } = this.model;
        switch (style.sizeMode) {
            case 'fixed':
                return slider(
                    'Size',
                    style.sizePixels,
                    { min: 1, max: 20, logarithmic: true, digits: 2 },
                    `${style.sizePixels} px`,
                    (sizePixels) => this.model.changeStyle({ sizePixels }),
                );
            case 'world':
                return slider(
                    'Size',
                    style.sizeWorld,
                    { min: 0.001, max: 10, logarithmic: true, digits: 2 },
                    String(style.sizeWorld),
                    (sizeWorld) => this.model.changeStyle({ sizeWorld }),
                );
            case 'spacing':
            case 'adaptive':
                return slider(
                    'Size',
                    style.sizeSpacings,
                    { min: 0.5, max: 5, logarithmic: true, digits: 2 },
                    `${style.sizeSpacings} ×`,
                    (sizeSpacings) => this.model.changeStyle({ sizeSpacings }),
                );
        }
    }

    private renderLight(): TemplateResult {
        const { edl } = this.model.style;
        return html`<fieldset>
            <legend>Eye-dome lighting</legend>
            <label class="row">
                <span>Shade</span>
                <span>
                    <input
                        type="checkbox"
                        aria-label="Eye-dome lighting"
                        .checked=${edl.enabled}
                        @change=${(event: Event) =>
                            this.model.changeStyle({
                                edl: { enabled: (event.target as HTMLInputElement).checked },
                            })}
                    />
                </span>
            </label>
            ${slider(
                'Strength',
                edl.strength,
                { min: 0, max: 2, digits: 2 },
                String(edl.strength),
                (strength) => this.model.changeStyle({ edl: { strength } }),
                !edl.enabled,
            )}
            ${slider(
                'Radius',
                edl.radiusPixels,
                { min: 0.5, max: 5, digits: 2 },
                `${edl.radiusPixels} px`,
                (radiusPixels) => this.model.changeStyle({ edl: { radiusPixels } }),
                !edl.enabled,
            )}
        </fieldset>`;
    }
}

customElements.define('stipple-look', LookPanel);
