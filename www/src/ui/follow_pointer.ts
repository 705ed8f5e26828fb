/** Calls `move` as the pointer goes on that went down on an element, then `drop` once, when it is lifted or taken away. */
export function followPointer(
    { currentTarget, pointerId }: PointerEvent,
    move: (moved: PointerEvent) => void,
    drop: () => void = () => {},
): void {
    const element = currentTarget as HTMLElement, until = new AbortController();
    const end = (): void => {
        until.abort();
        drop();
    };
    element.setPointerCapture(pointerId);
    element.addEventListener('pointermove', move, until);
    element.addEventListener('pointerup', end, until);
    element.addEventListener('pointercancel', end, until);
}
