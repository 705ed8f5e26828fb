import type { Model } from '../model.ts';
import type { ClipBox, Vector } from '../wasm/values.ts';
import { headingOf, placeIn, turnedAbout, withCentre, withFaceMoved, withHeading } from './boxes.ts';
import { along, type Handle, inPlane, type Place } from './handles.ts';

/** Of a clip box: its sides, its middle, and knobs that turn it: at the end of its x about z, at that of y about its x, at that of z about its y. `name`: the box's. */
export function boxHandles(model: Model, index: number, name: string): Handle[] {
    return new BoxHandles(model, index, name).list();
}

/** An arrow key turns so far, in degrees. */
const keyTurn = 1;
/** Knobs lie beyond the sides, by parts of the half size. */
const knobPart = 1.4;
/** The axis that a knob lies on, and the one that it turns towards; about the third. */
const knobs = [['turn', 0, 1], ['turnX', 1, 2], ['turnY', 2, 0]] as const;
const sides = [0, 1, 2].flatMap((axis) => [1, -1].map((sign) => ({ axis, sign })));

class BoxHandles {
    constructor(
        private readonly model: Model,
        private readonly index: number,
        private readonly name: string,
    ) {}

    list(): Handle[] {
        const { box, name } = this, { texts } = this.model;
        if (!box) return [];
        const places = [...sides.map(({ axis, sign }) => faceOf(box, axis, sign)), ...knobs.map(([, axis]) => faceOf(box, axis, knobPart)), [0, 0, 0] as Vector];
        const shown = this.model.surface.project(places.map((place) => placeIn(box, place)));
        const made: Omit<Handle, 'at'>[] = [
            ...sides.map(({ axis, sign }) => this.side(axis, sign)),
            ...knobs.map(([which, axis, towards]) => ({
                kind: 'handle' as const,
                which,
                label: texts.text('clip.turn', { name, axis: 'xyz'[3 - axis - towards]! }),
                move: this.change((from, step, event) => this.turned(from, axis, towards, step, event)),
            })),
            { kind: 'handle', which: 'centre', label: texts.text('clip.middle', { name }), move: this.change((from, step) => this.shifted(from, step)) },
        ];
        return made.flatMap((handle, i) => (shown[i] ? [{ ...handle, at: shown[i] }] : []));
    }

    private side(axis: number, sign: number): Omit<Handle, 'at'> {
        const which = `${'xyz'[axis]}${sign > 0 ? '+' : '-'}`;
        const outwards = (box: ClipBox): Place => this.pixelsAlong(box, faceOf(box, axis, sign), axis, sign);
        return {
            kind: 'face',
            which,
            label: this.model.texts.text('clip.side', { side: which, name: this.name }),
            move: this.change((from, step) => withFaceMoved(from, axis, sign, along(step, outwards(from)))),
        };
    }
    private get box(): ClipBox | undefined {
        return this.model.clipping.boxes[this.index];
    }
    private change(next: (from: ClipBox, step: Place, event?: PointerEvent) => ClipBox | undefined): Handle['move'] {
        return (step, event) => {
            const changed = this.box && next(this.box, step, event);
            if (changed) this.model.clipping.change(this.index, changed);
        };
    }

    /** How one world unit along an axis shows at a place of the box. */
    private pixelsAlong(box: ClipBox, from: Vector, axis: number, sign: number): Place {
        const unit = 0.05 * box.halfSize[axis]!;
        const to = from.map((value, at) => (at === axis ? value + sign * unit : value)) as Vector;
        const [a, b] = this.model.surface.project([placeIn(box, from), placeIn(box, to)]);
        return a && b ? { x: (b.x - a.x) / unit, y: (b.y - a.y) / unit } : { x: 0, y: 0 };
    }

    /** Along its own x and y, or, seen from the side, along z and the one of them that shows. */
    private shifted(box: ClipBox, step: Place): ClipBox | undefined {
        const pixels = [0, 1, 2].map((axis) => this.pixelsAlong(box, [0, 0, 0], axis, 1));
        for (const [a, b] of [[0, 1], [0, 2], [1, 2]] as const) {
            const ways = inPlane(step, pixels[a]!, pixels[b]!);
            if (!ways) continue;
            const move: Vector = [0, 0, 0];
            [move[a], move[b]] = ways;
            return withCentre(box, placeIn(box, move));
        }
        return undefined;
    }

    /** The knob comes to lie in the direction of the pointer; by keys it goes on, right and up counter-clockwise. */
    private turned(box: ClipBox, axis: number, towards: number, step: Place, event?: PointerEvent): ClipBox | undefined {
        const way = event ? this.wayTo(box, axis, towards, event) : Math.sign(step.x - step.y) * keyTurn * Math.max(1, Math.hypot(step.x, step.y) / 4);
        if (way === undefined) return undefined;
        const heading = axis === 0 ? headingOf(box) : undefined, isCoarse = event?.shiftKey ?? false;
        const rounded = (degrees: number): number => (isCoarse ? Math.round(degrees / 15) * 15 : degrees);
        return heading === undefined ? turnedAbout(box, axis, towards, rounded(way)) : withHeading(box, rounded(heading + way));
    }
    /** Degrees from the knob's axis to the pointer, in its plane. */
    private wayTo(box: ClipBox, axis: number, towards: number, event: PointerEvent): number | undefined {
        const area = this.model.canvas.getBoundingClientRect(), [centre] = this.model.surface.project([box.centre]);
        if (!centre) return undefined;
        const step = { x: event.clientX - area.left - centre.x, y: event.clientY - area.top - centre.y };
        const ways = inPlane(step, this.pixelsAlong(box, [0, 0, 0], axis, 1), this.pixelsAlong(box, [0, 0, 0], towards, 1));
        return ways && (Math.atan2(ways[1], ways[0]) * 180) / Math.PI;
    }
}

function faceOf(box: ClipBox, axis: number, sign: number): Vector {
    const place: Vector = [0, 0, 0];
    place[axis] = sign * box.halfSize[axis]!;
    return place;
}
