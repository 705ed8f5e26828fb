import './profile_chart.ts';

import { css, html, type TemplateResult } from 'lit';

import type { Profile } from '../profile/profile.ts';
import type { ProfileColour } from '../profile/profile_colours.ts';
import type { RegionFormat } from '../wasm/values.ts';
import { download } from './download.ts';
import { ModelElement } from './model_element.ts';
import type { ProfileChart } from './profile_chart.ts';
import { servedLink } from './served_link.ts';
import { controlStyles } from './shared_styles.ts';

const formats = ['laz', 'las', 'csv'];
type Corridor = 'off' | 'highlight' | 'hideOutside';
const corridors: Corridor[] = ['off', 'highlight', 'hideOutside'];
const ownFormats: RegionFormat[] = ['laz', 'las', 'csv'];

/** A profile and what can be done with it: how it is cut, drawn and kept. Its view is ProfileChart. */
export class ProfilePanel extends ModelElement {
    static override properties = { ...ModelElement.properties, colour: { state: true } };
    /** None was chosen: the first that the clouds have. */
    declare colour: ProfileColour | undefined;

    static override styles = [
        controlStyles,
        css`
            .bar {
                display: flex;
                flex-wrap: wrap;
                align-items: center;
                gap: 0.3rem 0.9rem;
                font-size: 0.82rem;
            }
            .bar h2 {
                margin: 0;
            }
            .bar label {
                display: flex;
                align-items: center;
                gap: 0.4rem;
            }
            .bar input {
                width: 4.5rem;
            }
            .bar a {
                color: var(--accent);
            }
            .bar button {
                min-height: 1.75rem;
            }
            .state {
                unicode-bidi: plaintext;
                color: var(--muted);
            }
            .close {
                margin-inline-start: auto;
            }
            .error {
                margin: 0.3rem 0 0;
                font-size: 0.82rem;
                user-select: text;
                color: var(--danger);
            }
        `,
    ];

    protected override sources(): EventTarget[] {
        return [this.profile, this.model.regionFiles];
    }

    private get profile(): Profile {
        return this.model.profile;
    }
    private get chart(): ProfileChart {
        return this.renderRoot.querySelector<ProfileChart>('stipple-profile-chart')!;
    }

    override render(): TemplateResult {
        const { profile } = this, { points } = profile, modes = this.colourModes(), colour = this.colour ?? modes[0]!;
        const state = this.text(
            profile.isLoading ? 'profile.loading' : profile.isComplete ? 'profile.complete' : 'profile.thinned',
        );
        return html`<div class="bar">
                <h2>${this.text('profile')}</h2>
                <label>
                    ${this.text('profile.width')}
                    <input
                        type="number"
                        step="any"
                        min="0"
                        aria-label=${this.text('profile.widthLabel')}
                        .value=${String(profile.width)}
                        @change=${(event: Event) => profile.setWidth((event.target as HTMLInputElement).valueAsNumber)}
                    />
                </label>
                <label>
                    ${this.text('profile.exaggeration')}
                    <input
                        type="number"
                        step="0.5"
                        min="0.1"
                        max="100"
                        aria-label=${this.text('profile.exaggerationLabel')}
                        .value=${String(profile.exaggeration)}
                        @change=${(event: Event) => this.exaggerate((event.target as HTMLInputElement).valueAsNumber)}
                    />
                </label>
                ${this.renderChoice(this.text('profile.colour'), colour, modes.map((mode) => [mode, this.text(`colour.${mode}`)]), (mode) => (this.colour = mode))}
                ${this.renderChoice<Corridor>(
                    this.text('profile.inPicture'),
                    (profile.corridor?.mode as Corridor | undefined) ?? 'off',
                    corridors.map((mode) => [mode, this.text(mode === 'off' ? 'profile.corridorOff' : mode === 'highlight' ? 'clip.highlight' : 'profile.isolate')]),
                    (mode) => profile.showCorridor(mode === 'off' ? undefined : mode),
                )}
                <button @click=${() => this.chart.fit()}>${this.text('profile.fit')}</button>
                <span class="state" role="status" data-points=${points.count}>
                    ${this.text('profile.state', { count: points.count, state })}
                </span>
                ${formats.flatMap((format) =>
                    profile
                        .addresses(format)
                        .map(({ name, href }) =>
                            servedLink(this.model, href, format, `${name}-profile`, this.text('profile.allPoints', { name })),
                        ),
                )}
                ${profile.ownClouds().map(({ id, name }) => this.renderOwnFiles(id, name))}
                <a href="" @click=${(event: Event) => this.savePicture(event)}>SVG</a>
                <button class="quiet close" aria-label=${this.text('profile.close')} @click=${() => profile.close()}>✕</button>
            </div>
            ${profile.error ? html`<p class="error" role="alert">${profile.error}</p>` : ''}
            <stipple-profile-chart .model=${this.model} .colour=${colour}></stipple-profile-chart>`;
    }

    private renderChoice<T extends string>(label: string, value: T, options: [T, string][], change: (value: T) => void): TemplateResult {
        return html`<label>
            ${label}
            <select @change=${(event: Event) => change((event.target as HTMLSelectElement).value as T)}>
                ${options.map(([option, text]) => html`<option value=${option} ?selected=${option === value}>${text}</option>`)}
            </select>
        </label>`;
    }

    /** Files of a cloud that no server cuts. */
    private renderOwnFiles(id: number, name: string): TemplateResult {
        const { profile } = this, { regionFiles } = this.model, key = `profile ${id}`, running = regionFiles.of(key);
        if (running) {
            const { share, points } = running, format = running.format.toUpperCase();
            return html`<span role="status">${this.text('region.making', { format, share: Math.round(100 * share), points })}</span>
                <button @click=${() => running.cancel()}>${this.text('region.cancel')}</button>`;
        }
        const save = (format: RegionFormat): void =>
            void regionFiles.save(key, id, profile.region, format, `${name.replace(/\.stipple$/, '')}-profile`);
        return html`${ownFormats.map(
            (format) => html`<button title=${this.text('profile.allPoints', { name })} @click=${() => save(format)}>
                ${format.toUpperCase()}
            </button>`,
        )}`;
    }

    /** That the clouds have values for. */
    private colourModes(): ProfileColour[] {
        const has = (attribute: string): boolean =>
            this.model.clouds.some(({ attributes }) => attributes?.includes(attribute));
        const needs: [ProfileColour, string?][] = [
            ['rgb', 'Red'],
            ['elevation'],
            ['classification', 'Classification'],
            ['returnNumber', 'Return Number'],
            ['intensity', 'Intensity'],
        ];
        return needs.flatMap(([mode, attribute]) => (attribute === undefined || has(attribute) ? [mode] : []));
    }

    private exaggerate(value: number): void {
        this.profile.exaggerate(value);
        this.chart.fit();
    }
    private savePicture(event: Event): void {
        event.preventDefault();
        const picture = this.chart.picture();
        if (picture) download(picture, 'profile.svg');
    }
}

customElements.define('stipple-profile', ProfilePanel);
