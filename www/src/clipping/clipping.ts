import type { Model } from '../model.ts';
import type { ClipBox, CloudState } from '../wasm/values.ts';
import { withHeading } from './boxes.ts';

/** The clip boxes of the style, and which of them is being edited. */
export class Clipping {
    /** Index of the box that has handles; -1: none. */
    selected = -1;

    constructor(private readonly model: Model) {}

    get boxes(): ClipBox[] {
        return this.model.style.clipBoxes;
    }

    /** A box around the point in the middle of the picture, or what the camera turns about; a third as high as the view there. */
    async add(): Promise<void> {
        const { canvas } = this.model;
        const middle = await this.model.picking.place(canvas.clientWidth / 2, canvas.clientHeight / 2, 60);
        const { target, position, projection, orthoHeight, fovYDegrees } = this.model.camera.read();
        const centre = middle ?? target;
        const distance = Math.hypot(...centre.map((value, axis) => value - position[axis]!));
        const height =
            projection === 'orthographic' ? orthoHeight : 2 * distance * Math.tan((fovYDegrees * Math.PI) / 360);
        const half = height / 6;
        const box = withHeading({ mode: 'hideOutside', centre, halfSize: [half, half, half] }, 0);
        this.selected = this.boxes.length;
        this.set([...this.boxes, box]);
    }

    change(index: number, box: ClipBox): void {
        if (box.halfSize.every((half: number) => half > 0) && [...box.centre, ...box.halfSize].every(Number.isFinite))
            this.set(this.boxes.map((old, at) => (at === index ? box : old)));
    }
    remove(index: number): void {
        if (this.selected === index) this.selected = -1;
        else if (this.selected > index) this.selected -= 1;
        this.set(this.boxes.filter((_, at) => at !== index));
    }
    select(index: number): void {
        this.selected = this.selected === index ? -1 : index;
        this.model.changeStyle({}); // tells the elements
    }

    /** Addresses of the server's points of each cloud, where this page's server has it. */
    apisOfClouds(): { cloud: number; name: string; api: string }[] {
        const { server } = this.model;
        if (!server) return [];
        return this.model.listing.clouds
            .filter((cloud) => this.model.isOpen(cloud.address))
            .map(({ id, name, address }) => ({
                cloud: this.model.idOf(address)!,
                name,
                api: new URL(`api/v1/clouds/${encodeURIComponent(id)}`, server).href,
            }));
    }

    /** Those whose points the page has to read itself: of static hosts, and files. */
    cloudsWithoutApi(): CloudState[] {
        const served = this.model.listing.clouds.map(({ address }) => address);
        return this.model.clouds.filter(
            ({ id, stage }) => stage === 'ready' && !served.includes(this.model.addressOf(id) ?? ''),
        );
    }

    private set(clipBoxes: ClipBox[]): void {
        this.model.changeStyle({ clipBoxes });
    }
}

/** World units along two directions for a step of the pointer, where these show as `a` and `b` (pixels a unit); none if they show as one line. */
export function inPlane(
    step: { x: number; y: number },
    a: { x: number; y: number },
    b: { x: number; y: number },
): [number, number] | undefined {
    const area = a.x * b.y - a.y * b.x;
    if (Math.abs(area) < 0.02 * Math.hypot(a.x, a.y) * Math.hypot(b.x, b.y) || area === 0) return undefined;
    return [(step.x * b.y - step.y * b.x) / area, (a.x * step.y - a.y * step.x) / area];
}

/** World units along one direction that shows as `a`. */
export function along(step: { x: number; y: number }, a: { x: number; y: number }): number {
    const square = a.x * a.x + a.y * a.y;
    return square > 1e-12 ? (step.x * a.x + step.y * a.y) / square : 0;
}

