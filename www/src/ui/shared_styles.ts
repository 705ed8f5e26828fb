import { css } from 'lit';

/** Controls as every panel has them. */
export const controlStyles = css`
    :host {
        display: block;
        color: var(--text);
    }
    *,
    *::before,
    *::after {
        box-sizing: border-box;
    }
    .unseen {
        position: absolute;
        width: 1px;
        height: 1px;
        margin: -1px;
        overflow: hidden;
        clip-path: inset(50%);
        white-space: nowrap;
    }
    [hidden] {
        display: none !important;
    }
    h2,
    legend {
        margin: 0 0 0.6rem;
        padding: 0;
        font-size: 0.75rem;
        font-weight: 600;
        letter-spacing: 0.07em;
        text-transform: uppercase;
        color: var(--muted);
    }
    fieldset {
        border: 0;
        margin: 0;
        padding: 0;
        min-width: 0;
    }
    .row {
        display: grid;
        grid-template-columns: 6.4rem 1fr;
        align-items: center;
        gap: 0.5rem;
        min-height: 2rem;
        margin-top: 0.35rem;
    }
    .row > span:first-child {
        overflow-wrap: break-word;
    }
    .value {
        display: grid;
        grid-template-columns: 1fr minmax(3.6rem, auto);
        align-items: center;
        gap: 0.5rem;
    }
    /* Numbers before their units, also where text runs from right to left. */
    dd,
    output {
        unicode-bidi: plaintext;
    }
    output {
        text-align: end;
        color: var(--muted);
        font-variant-numeric: tabular-nums;
        white-space: nowrap;
    }
    button,
    select {
        font: inherit;
        color: inherit;
        background: var(--raised);
        border: 1px solid var(--line);
        border-radius: 6px;
        min-height: 2rem;
        padding: 0 0.7rem;
    }
    button {
        cursor: pointer;
    }
    button:hover,
    select:hover {
        background: var(--raised-hover);
    }
    .quiet {
        background: none;
        border-color: transparent;
        color: var(--muted);
        padding: 0 0.5rem;
    }
    select {
        width: 100%;
        padding: 0 0.4rem;
    }
    :where(input:not([type='range'], [type='checkbox'], [type='radio'], [type='file']), textarea) {
        width: 100%;
        min-width: 0;
        font: inherit;
        font-size: 0.85rem;
        color: inherit;
        background: var(--raised);
        border: 1px solid var(--line);
        border-radius: 6px;
        padding: 0.25rem 0.4rem;
    }
    /* Firefox shows arrows all the time, over the digits; those of the keyboard do the same. */
    input[type='number'] {
        -moz-appearance: textfield;
    }
    input[type='range'] {
        width: 100%;
        min-width: 0;
        height: 2rem;
        margin: 0;
        accent-color: var(--accent);
    }
    input[type='checkbox'] {
        width: 1.05rem;
        height: 1.05rem;
        margin: 0;
        accent-color: var(--accent);
    }
    :focus-visible {
        outline: 2px solid var(--accent);
        outline-offset: 2px;
    }
    /* A finger's least target (WCAG 2.2, 2.5.8). */
    input:not([type='checkbox'], [type='radio'], [type='file']),
    textarea {
        min-block-size: 24px;
    }
    .choice {
        display: flex;
        flex-wrap: wrap;
        background: var(--raised);
        border: 1px solid var(--line);
        border-radius: 6px;
        overflow: hidden;
    }
    .choice label {
        flex: 1 0 auto;
        position: relative;
    }
    .choice input {
        position: absolute;
        opacity: 0;
        inset: 0;
        width: 100%;
        height: 100%;
        margin: 0;
        cursor: pointer;
    }
    .choice span {
        display: block;
        padding: 0.3rem 0.3rem;
        text-align: center;
        color: var(--muted);
    }
    .choice label:hover span {
        color: var(--text);
    }
    .choice input:checked + span {
        background: var(--accent);
        color: var(--accent-ink);
        font-weight: 600;
    }
    .choice input:focus-visible + span {
        outline: 2px solid var(--accent);
        outline-offset: -4px;
        outline-color: var(--text);
    }
    @media (pointer: coarse) {
        button,
        select,
        .row,
        input[type='range'] {
            min-height: 2.6rem;
        }
        .choice span {
            padding: 0.55rem 0.3rem;
        }
    }
`;

/** A panel's head: its title, and what closes it. */
export const headStyles = css`
    header {
        display: flex;
        justify-content: space-between;
        align-items: center;
        gap: 0.4rem;
    }
    header h2 {
        margin: 0;
        flex: 1;
    }
`;

/** Names and values, as lists of them are written. */
export const factStyles = css`
    dl {
        display: grid;
        grid-template-columns: auto 1fr;
        gap: 0.15rem 1.2rem;
        margin: 0.6rem 0 0;
        font-size: 0.82rem;
        user-select: text;
    }
    dt {
        color: var(--muted);
    }
    dd {
        margin: 0;
        text-align: end;
        font-variant-numeric: tabular-nums;
        overflow-wrap: anywhere;
    }
`;

/** Lists of things that are edited in place: a card each. */
export const cardStyles = css`
    ul {
        list-style: none;
        margin: 0.6rem 0 0;
        padding: 0;
        display: grid;
        gap: 0.6rem;
    }
    li {
        border: 1px solid var(--line);
        border-radius: 8px;
    }
`;
