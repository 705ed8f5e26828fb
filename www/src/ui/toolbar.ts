/**
 * A row of buttons is one stop of the Tab key; arrows, Home and End go from button to button (WAI-ARIA's toolbar pattern). On
 * the element with role="toolbar": @keydown=${followToolbarKeys} @focusin=${keepToolbarStop}; its buttons: tabindex=${stopOf(index)}.
 */
export function followToolbarKeys(event: KeyboardEvent): void {
    const bar = event.currentTarget as HTMLElement;
    const buttons = buttonsOf(bar).filter((button) => !button.disabled);
    const at = buttons.indexOf(event.target as HTMLButtonElement);
    const forwards = getComputedStyle(bar).direction === 'rtl' ? -1 : 1;
    const steps: Record<string, number> = { ArrowRight: forwards, ArrowLeft: -forwards, ArrowDown: 1, ArrowUp: -1 };
    const step = steps[event.key];
    const next =
        step !== undefined
            ? buttons[(at + step + buttons.length) % buttons.length]
            : { Home: buttons[0], End: buttons.at(-1) }[event.key];
    if (!next || at < 0) return;
    event.preventDefault();
    next.focus();
}

/** The Tab key comes back to the button that had the focus last. */
export function keepToolbarStop(event: FocusEvent): void {
    for (const button of buttonsOf(event.currentTarget as HTMLElement)) button.tabIndex = button === event.target ? 0 : -1;
}

/** Of its buttons, at first. */
export function stopOf(index: number): number {
    return index === 0 ? 0 : -1;
}

function buttonsOf(bar: HTMLElement): HTMLButtonElement[] {
    return [...bar.querySelectorAll('button')];
}
