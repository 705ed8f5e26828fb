import { css } from 'lit';

/** Where everything over the picture lies, in wide viewers and in narrow ones. Clicks beside it go to the picture. */
export const appLayout = css`
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
    .panel,
    .status {
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
    .controls[closed] {
        width: auto;
        padding: 8px 10px;
    }
    .counters {
        grid-column: 2;
        grid-row: 1;
        justify-self: end;
        width: 250px;
    }
    /* One above the other, beside the map. */
    .counters:has(~ .point),
    .counters ~ .point {
        max-height: calc(50% - 6px);
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
    }
    .status {
        grid-column: 2 / 4;
        grid-row: 3;
        justify-self: end;
        align-self: end;
    }
    .notices {
        position: absolute;
        grid-column: 2 / 4;
        inset: 12px 0 auto;
        margin-inline: auto;
        width: min(520px, 100%);
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
        .controls[closed] {
            width: 100%;
        }
        .notices {
            grid-column: 1;
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
            width: min(100%, 320px);
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
        .counters:has(~ .point, ~ .map, ~ .profile),
        .map:has(~ .profile),
        .point ~ .map,
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
`;
