// Walks by the keyboard alone, as somebody without a pointer does.

/** What has the focus, through all shadow trees: its name, and how one sees that it has it. */
export function focused(page) {
    return page.evaluate(() => {
        let at = document.activeElement;
        while (at?.shadowRoot?.activeElement) at = at.shadowRoot.activeElement;
        if (!at || at === document.body) return null;
        const outlined = (element) => {
            const { outlineStyle, outlineWidth } = getComputedStyle(element);
            return outlineStyle !== 'none' && parseFloat(outlineWidth) >= 2;
        };
        const ring = at.tagName === 'CANVAS' && getComputedStyle(at.nextElementSibling).boxShadow !== 'none';
        // Radio buttons are drawn by the text beside them.
        const isSeen = ring || outlined(at) || (at.nextElementSibling !== null && outlined(at.nextElementSibling));
        const label = at.labels?.[0]?.querySelector('span')?.textContent ?? at.textContent;
        const name = (at.getAttribute('aria-label') ?? label ?? '').trim().replace(/\s+/g, ' ');
        return { name, tag: at.tagName.toLowerCase(), type: at.type ?? '', isSeen };
    });
}

/** Presses Tab until something of that name has the focus; an error if it never does. Each stop on the way must be seen. */
export async function tabTo(page, name, { backwards = false, most = 200, stops = [] } = {}) {
    for (let i = 0; i < most; i++) {
        await page.keyboard.press(backwards ? 'Shift+Tab' : 'Tab');
        const at = await focused(page);
        if (!at) continue; // the browser's own controls, at the end of the page
        stops.push(at.name);
        if (!at.isSeen) throw new Error(`the focus on ${at.tag} "${at.name}" can't be seen`);
        if (at.name === name) return at;
    }
    throw new Error(`the Tab key does not come to "${name}": ${stops.join(' | ')}`);
}
