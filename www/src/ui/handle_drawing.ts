import { nothing, svg, type SVGTemplateResult } from 'lit';

import type { Handle, Place } from '../clipping/handles.ts';

const directions: Record<string, Place> = { ArrowLeft: { x: -1, y: 0 }, ArrowRight: { x: 1, y: 0 }, ArrowUp: { x: 0, y: -1 }, ArrowDown: { x: 0, y: 1 } };
/** Pixels of a press of an arrow key. */
const fineStep = 4;
const coarseStep = 20;
/** Two clicks on the same handle so soon after each other, with less movement (pixels) between, are a double click. */
const doubleClickMs = 400;
const slop = 4;

interface Host {
    renderRoot: ParentNode;
    updateComplete: Promise<unknown>;
    requestUpdate(): void;
    followPointer(event: PointerEvent, follow: (moved: PointerEvent) => void): void;
}

/**
 * Handles over the picture. All of them are one stop of the Tab key; arrows move the one that has the focus (with shift, farther), Page Up
 * and Page Down go to the others, Delete takes one away, Enter makes one that is not there yet.
 */
export class HandleDrawing {
    /** What the Tab key comes to. */
    private stop = '';
    private clicked: { handle: string; at: number } | undefined;

    constructor(private readonly host: Host) {}

    render(handles: Handle[], canBeTaken: boolean): SVGTemplateResult[] {
        if (!handles.some((handle) => nameOf(handle) === this.stop)) this.stop = handles[0] ? nameOf(handles[0]) : '';
        return handles.map((handle) => this.renderHandle(handle, canBeTaken && nameOf(handle) === this.stop));
    }

    private renderHandle(handle: Handle, isStop: boolean): SVGTemplateResult {
        const { kind, which, label, at: { x, y } } = handle, of = (known: Handle['kind']): string | typeof nothing => (kind === known ? which : nothing);
        const focus = (): void => {
            this.stop = nameOf(handle);
            this.host.requestUpdate();
        };
        const key = (event: KeyboardEvent): void => void this.key(event, handle), press = (event: PointerEvent): void => this.press(event, handle);
        const click = (event: MouseEvent): void => this.click(event, handle);
        return kind === 'face'
            ? svg`<rect class="handle" data-face=${which} role="button" tabindex=${isStop ? 0 : -1} aria-label=${label}
                x=${x - 5} y=${y - 5} width="10" height="10" @focus=${focus} @keydown=${key} @pointerdown=${press}></rect>`
            : svg`<circle class="handle ${kind}" data-handle=${of('handle')} data-corner=${of('corner')} data-new=${of('new')}
                role="button" tabindex=${isStop ? 0 : -1} aria-label=${label}
                cx=${x} cy=${y} r=${kind === 'new' ? 4 : 6} @focus=${focus} @keydown=${key} @pointerdown=${press} @click=${click}></circle>`;
    }

    private press(event: PointerEvent, handle: Handle): void {
        const from = { x: event.clientX, y: event.clientY };
        let last = from;
        this.host.followPointer(event, (moved) => {
            if (Math.hypot(moved.clientX - from.x, moved.clientY - from.y) > slop) this.clicked = undefined;
            const step = { x: moved.clientX - last.x, y: moved.clientY - last.y };
            last = { x: moved.clientX, y: moved.clientY };
            if (step.x !== 0 || step.y !== 0) handle.move(step, moved);
        });
        (event.currentTarget as SVGElement).focus({ preventScroll: true });
    }
    /** With the second click, and no sooner: what the browser makes of the two is for the handle, not for the picture under it. */
    private click(event: MouseEvent, handle: Handle): void {
        const name = nameOf(handle), isSecond = this.clicked?.handle === name && event.timeStamp - this.clicked.at < doubleClickMs;
        this.clicked = isSecond ? undefined : { handle: name, at: event.timeStamp };
        if (isSecond) handle.remove?.();
    }

    private async key(event: KeyboardEvent, handle: Handle): Promise<void> {
        if (event.ctrlKey || event.altKey || event.metaKey) return;
        const direction = directions[event.key], other = { PageUp: -1, PageDown: 1 }[event.key], size = event.shiftKey ? coarseStep : fineStep;
        if (other) this.focusOther(event.currentTarget as SVGElement, other);
        else if (direction) handle.move({ x: direction.x * size, y: direction.y * size });
        else if (['Delete', 'Backspace'].includes(event.key)) handle.remove?.();
        else if (['Enter', ' '].includes(event.key)) handle.make?.();
        else return;
        event.preventDefault();
        // What was a corner that may be is the next corner; where one was, there is the one after it.
        const next = handle.kind === 'new' ? Number(handle.which) + 1 : handle.kind === 'corner' && handle.remove && !direction && !other ? Number(handle.which) : undefined;
        if (next === undefined || other) return;
        await this.host.updateComplete;
        const corners = this.host.renderRoot.querySelectorAll<SVGElement>('[data-corner]');
        corners[Math.min(next, corners.length - 1)]?.focus();
    }

    private focusOther(element: SVGElement, step: number): void {
        const handles = [...element.parentNode!.querySelectorAll<SVGElement>('.handle')];
        handles[(handles.indexOf(element) + step + handles.length) % handles.length]!.focus();
    }
}

function nameOf({ kind, which }: Handle): string {
    return `${kind} ${which}`;
}
