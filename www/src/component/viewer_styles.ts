import { css } from 'lit';

/** The viewer's box, its colours in both themes, and the canvas. Colours of text meet WCAG 2.2 AA on every surface here. */
export const viewerStyles = css`
    :host {
        color-scheme: light dark;
        --panel: light-dark(rgb(255 255 255 / 0.95), rgb(26 29 34 / 0.92));
        --panel-solid: light-dark(#ffffff, #1a1d22);
        --raised: light-dark(#eef0f3, #272b32);
        --raised-hover: light-dark(#e0e4e9, #313640);
        --line: light-dark(#c6ccd5, #353a44);
        --text: light-dark(#1b1f24, #e8eaed);
        --muted: light-dark(#525c69, #a3abb8);
        --accent: light-dark(#0a6f5f, #6cc5b4);
        --accent-ink: light-dark(#ffffff, #0d211d);
        --danger: light-dark(#a3261b, #ff9b8e);
        --danger-back: light-dark(#fdecea, #3a2226);
        --back: light-dark(#f4f5f7, #181a1e);
        display: block;
        position: relative;
        overflow: hidden;
        min-height: 8rem;
        contain: strict;
        container-type: size;
        background: var(--back);
        color: var(--text);
        font: 1rem/1.4 system-ui, -apple-system, 'Segoe UI', Roboto, 'Noto Sans', 'Noto Sans CJK JP', 'Liberation Sans', sans-serif;
    }
    :host([hidden]) {
        display: none;
    }
    :host([theme='dark']) {
        color-scheme: dark;
    }
    :host([theme='light']) {
        color-scheme: light;
    }
    canvas {
        position: absolute;
        inset: 0;
        width: 100%;
        height: 100%;
        display: block;
        touch-action: none;
        cursor: grab;
        outline: none;
    }
    canvas:active {
        cursor: grabbing;
    }
    .ring {
        position: absolute;
        inset: 0;
        pointer-events: none;
    }
    canvas:focus-visible + .ring {
        box-shadow:
            inset 0 0 0 2px var(--accent),
            inset 0 0 0 4px var(--panel-solid);
    }
    /* Where the space bar clicks. */
    .cross {
        display: none;
        position: absolute;
        inset: calc(50% - 9px) auto auto calc(50% - 9px);
        width: 18px;
        height: 18px;
        pointer-events: none;
        background:
            linear-gradient(#fff, #fff) center / 2px 100% no-repeat,
            linear-gradient(#fff, #fff) center / 100% 2px no-repeat;
        filter: drop-shadow(0 0 1px #000) drop-shadow(0 0 1px #000);
    }
    canvas:focus-visible ~ .cross {
        display: block;
    }
    .failure {
        box-sizing: border-box;
        position: relative;
        max-width: min(34rem, 100% - 2rem);
        margin: 20cqh auto 0;
        padding: 1rem 1.2rem;
        background: var(--danger-back);
        border: 1px solid var(--danger);
        border-radius: 10px;
        overflow-wrap: anywhere;
    }
`;
