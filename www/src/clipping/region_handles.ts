import type { Model } from '../model.ts';
import { Corners } from './corners.ts';
import type { Handle, Place } from './handles.ts';

/** Of the corners of a clip region, and, small, of the corners that its edges may get. `name`: the region's. */
export function regionHandles(model: Model, index: number, name: string): Handle[] {
    const corners = new Corners(model, index), shown = corners.shown(), { texts } = model;
    return shown.flatMap((at, corner): Handle[] => {
        const next = corner + 1 < shown.length || corners.isClosed ? shown[(corner + 1) % shown.length] : undefined;
        const number = corner + 1;
        return [
            ...(at ? [{
                kind: 'corner' as const,
                which: String(corner),
                label: texts.text('clip.corner', { number, name }),
                at,
                move: (step: Place) => void corners.move(corner, step),
                remove: () => void corners.remove(corner),
            }] : []),
            ...(at && next ? [newCorner(corners, corner, { x: (at.x + next.x) / 2, y: (at.y + next.y) / 2 }, texts.text('clip.newCorner', { number, name }))] : []),
        ];
    });
}

/** With its first step it is a corner, which goes on. */
function newCorner(corners: Corners, after: number, at: Place, label: string): Handle {
    let isMade = false;
    const make = (): void => void (isMade ||= corners.insert(after));
    const move = (step: Place): void => {
        make();
        if (isMade) corners.move(after + 1, step);
    };
    return { kind: 'new', which: String(after), label, at, make, move };
}
