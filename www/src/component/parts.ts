/** What lies in a viewer's box: the canvas, the ring that shows its focus, the cross where the space bar clicks. */
export function pictureParts(): [HTMLCanvasElement, HTMLElement, HTMLElement] {
    const canvas = document.createElement('canvas');
    canvas.tabIndex = 0;
    canvas.setAttribute('role', 'application');
    return [canvas, mark('ring'), mark('cross')];
}

/** What stands there instead where it can't start. */
export function failureBox(sentence: string): HTMLElement {
    const box = document.createElement('p');
    box.className = 'failure';
    box.setAttribute('role', 'alert');
    box.textContent = sentence;
    return box;
}

function mark(className: string): HTMLElement {
    return Object.assign(document.createElement('div'), { className });
}
