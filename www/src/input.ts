import type { Model } from './model.ts';

/** Pixels of one press of an arrow key. */
const keyStep = 40;
const keyZoom = 0.8;
/** A pointer that moves no farther, in pixels, between down and up is a click; fingers are less steady. */
const clickSlop = 3;
const tapSlop = 10;

/**
 * Pointer, wheel, touch and keys on the canvas become steps of the camera (navigation/navigator.ts). Left drag or one finger turns, or
 * moves the ground; right, middle or shift drag and three fingers do the other; two fingers pan; wheel and pinch zoom to the pointer; a double click flies
 * to the point there, F to all, U goes back and shift U forth; a click asks about the point, Escape lets go of it.
 * The space bar is a click in the middle. With a tool in hand a click takes the point, a double click or Enter is the end, Backspace takes the last point back.
 */
export function followInput(canvas: HTMLCanvasElement, model: Model): void {
    const { annotations, navigator } = model;
    const putAnnotation = async (x: number, y: number): Promise<void> => {
        const place = await model.picking.place(x, y);
        if (place) annotations.add(place);
    };
    /** What a click does there, or the space bar in the middle. */
    const act = (x: number, y: number): void => {
        if (model.tool) model.tool.click(x, y);
        else if (annotations.isPlacing) void putAnnotation(x, y);
        else void model.picking.show(x, y);
    };
    const fingers = new Map<number, { x: number; y: number }>();
    /** Where the one pointer went down; none once it has moved, or another came. */
    let pressed: { x: number; y: number } | undefined;

    /** The middle of all fingers, and how far apart the first two are. */
    const middleOfFingers = (): { x: number; y: number; spread: number } => {
        const all = [...fingers.values()], [a, b] = all;
        const mean = (axis: 'x' | 'y'): number => all.reduce((sum, finger) => sum + finger[axis], 0) / all.length;
        return { x: mean('x'), y: mean('y'), spread: a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0 };
    };
    const place = (event: PointerEvent | WheelEvent): { x: number; y: number } => {
        const box = canvas.getBoundingClientRect();
        return { x: event.clientX - box.left, y: event.clientY - box.top };
    };

    canvas.addEventListener('pointerdown', (event) => {
        canvas.setPointerCapture(event.pointerId);
        canvas.focus({ preventScroll: true });
        fingers.set(event.pointerId, place(event));
        pressed = fingers.size === 1 && event.button === 0 ? place(event) : undefined;
        if (fingers.size === 1) navigator.press(place(event), event.shiftKey || event.button !== 0);
        if (fingers.size === 3) navigator.press(middleOfFingers(), true);
        event.preventDefault();
    });

    canvas.addEventListener('pointermove', (event) => {
        const from = fingers.get(event.pointerId);
        const to = place(event);
        navigator.hover(to);
        if (!from) return;
        const slop = event.pointerType === 'touch' ? tapSlop : clickSlop;
        if (pressed && Math.hypot(to.x - pressed.x, to.y - pressed.y) > slop) pressed = undefined;
        if (fingers.size > 1) {
            const before = middleOfFingers();
            fingers.set(event.pointerId, to);
            const after = middleOfFingers();
            if (fingers.size > 2) return navigator.drag(before, after, true);
            model.camera.pan(after.x - before.x, after.y - before.y);
            if (before.spread > 0 && after.spread > 0) model.camera.zoom(before.spread / after.spread, after.x, after.y);
            return;
        }
        fingers.set(event.pointerId, to);
        navigator.drag(from, to, event.shiftKey || (event.buttons & 1) === 0);
    });

    const lift = (event: PointerEvent): void => {
        fingers.delete(event.pointerId);
    };
    canvas.addEventListener('pointerup', (event) => {
        lift(event);
        if (pressed) act(pressed.x, pressed.y);
        pressed = undefined;
    });
    canvas.addEventListener('pointercancel', lift);
    canvas.addEventListener('dblclick', (event) => {
        if (model.tool) model.tool.finishInTurn();
        else void navigator.flyTo({ x: event.offsetX, y: event.offsetY });
    });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());

    canvas.addEventListener(
        'wheel',
        (event) => {
            event.preventDefault();
            // Lines and pages as browsers report them, in pixels; a pinch on a touch pad comes with ctrlKey.
            const pixels = event.deltaY * [1, 16, 400][event.deltaMode]! * (event.ctrlKey ? 5 : 1);
            const { x, y } = place(event);
            navigator.wheel(Math.exp(Math.max(-400, Math.min(400, pixels)) * 0.0015), { x, y });
        },
        { passive: false },
    );

    canvas.addEventListener('keydown', (event) => {
        if (event.ctrlKey || event.altKey || event.metaKey) return;
        if (navigator.keyDown(event.key)) return event.preventDefault();
        const middle = { x: canvas.clientWidth / 2, y: canvas.clientHeight / 2 };
        const { tool } = model, place = tool?.cursor ?? middle, part = event.shiftKey ? 0.1 : 0.5;
        const move = tool?.moveCursor
            ? (dx: number, dy: number) => tool.moveCursor!(-dx * part, -dy * part)
            : event.shiftKey
            ? (dx: number, dy: number) => model.camera.pan(dx, dy)
            : (dx: number, dy: number) => model.camera.orbit(dx, dy);
        const actions: Record<string, () => void> = {
            ArrowLeft: () => move(keyStep, 0),
            ArrowRight: () => move(-keyStep, 0),
            ArrowUp: () => move(0, keyStep),
            ArrowDown: () => move(0, -keyStep),
            '+': () => model.camera.zoom(keyZoom, middle.x, middle.y),
            '=': () => model.camera.zoom(keyZoom, middle.x, middle.y),
            '-': () => model.camera.zoom(1 / keyZoom, middle.x, middle.y),
            '1': () => model.camera.showView('top'),
            '2': () => model.camera.showView('front'),
            '3': () => model.camera.showView('iso'),
            '4': () => model.camera.showView('side'),
            Home: () => model.camera.showView('iso'),
            f: () => void model.camera.flyToCloud(),
            u: () => model.camera.back(),
            U: () => model.camera.forward(),
            ' ': () => act(place.x, place.y),
            Escape: () => model.letGo(),
            ...(tool && { Enter: () => tool.finishInTurn(), Backspace: () => tool.takeBackInTurn() }),
        };
        const action = actions[event.key];
        if (!action) return;
        event.preventDefault();
        action();
    });
    canvas.addEventListener('keyup', (event) => navigator.keyUp(event.key));
    canvas.addEventListener('blur', () => navigator.letGo());
}

/** Clouds and scenes (.json) dropped on `target` are opened. `hover` says whether one is held over it. Until `signal` aborts. */
export function followDrops(
    target: HTMLElement,
    model: Model,
    hover: (isOver: boolean) => void,
    signal: AbortSignal,
): void {
    let depth = 0;
    const holdsFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes('Files') ?? false;
    const on = (name: 'dragenter' | 'dragover' | 'dragleave' | 'drop', act: (event: DragEvent) => void): void =>
        target.addEventListener(name, act, { signal });
    on('dragenter', (event) => {
        if (!holdsFiles(event)) return;
        event.preventDefault();
        hover(++depth > 0);
    });
    on('dragover', (event) => {
        if (holdsFiles(event)) event.preventDefault();
    });
    on('dragleave', (event) => {
        if (holdsFiles(event)) hover(--depth > 0);
    });
    on('drop', (event) => {
        if (!holdsFiles(event)) return;
        event.preventDefault();
        depth = 0;
        hover(false);
        for (const file of event.dataTransfer!.files)
            if (/\.json$/i.test(file.name)) void model.scenes.openFile(file);
            else model.opened.openFile(file);
    });
}
