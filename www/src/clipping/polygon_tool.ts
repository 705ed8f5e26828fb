import type { Model } from '../model.ts';
import type { Tool } from '../tool.ts';
import type { RegionOf, Vector } from '../wasm/values.ts';

/** On the ground: a footprint, of any height at first. On the screen: all that shows inside it. */
export type PolygonKind = 'ground' | 'screen';
type Place = { x: number; y: number };

/** Two clicks of a double click are as near as this, in pixels. */
const slop = 4;

/** Draws a clip polygon, corner by corner. */
export class PolygonTool implements Tool {
    /** Corners on the ground: places of points that were clicked. */
    ground: Vector[] = [];
    /** Where the next corner on the screen is set by the keyboard. */
    private pointer: Place;
    private corners: Place[] = [];
    /** The view that the corners on the screen belong to. */
    private view = '';
    /** Clicks are answered frames later, in their order. */
    private clicks: Promise<void> = Promise.resolve();

    constructor(
        private readonly model: Model,
        readonly kind: PolygonKind,
    ) {
        const { clientWidth, clientHeight } = model.canvas;
        this.pointer = { x: clientWidth / 2, y: clientHeight / 2 };
    }

    get cursor(): Place {
        const { clientWidth, clientHeight } = this.model.canvas;
        return this.kind === 'screen' ? this.pointer : { x: clientWidth / 2, y: clientHeight / 2 };
    }
    /** On the screen arrow keys move the cursor; for the ground they move the camera, and the middle is clicked. */
    get moveCursor(): ((dx: number, dy: number) => void) | undefined {
        if (this.kind === 'ground') return undefined;
        return (dx, dy) => {
            const { clientWidth, clientHeight } = this.model.canvas, { x, y } = this.pointer;
            this.pointer = { x: Math.min(clientWidth, Math.max(0, x + dx)), y: Math.min(clientHeight, Math.max(0, y + dy)) };
            this.model.changed();
        };
    }

    /** Corners on the screen; those of a view that is left are of no use any more. */
    get screen(): Place[] {
        if (this.corners.length > 0 && this.view !== this.viewNow()) this.corners = [];
        return this.corners;
    }

    click(x: number, y: number): void {
        this.inTurn(async () => {
            if (this.kind === 'ground') await this.addGround(x, y);
            else this.addScreen({ x, y });
        });
    }

    takeBackInTurn(): void {
        this.inTurn(() => {
            if (this.kind === 'ground') this.ground = this.ground.slice(0, -1);
            else this.corners = this.screen.slice(0, -1);
        });
    }

    /** With fewer than three corners there is nothing to keep; one that can't be is told about and stays in hand, to be mended. */
    finishInTurn(): void {
        this.inTurn(() => {
            const { clipping } = this.model;
            const count = this.kind === 'ground' ? this.ground.length : this.screen.length;
            if (count < 3) return clipping.endTool();
            clipping.addRegion({ mode: 'hideOutside', region: this.region() });
            clipping.endTool();
        });
    }
    /** As long as it is in hand; what goes wrong is told. */
    private inTurn(step: () => void | Promise<void>): void {
        this.clicks = this.clicks
            .then(() => (this.model.clipping.tool === this ? step() : undefined))
            .catch((error: unknown) => this.model.tell(error))
            .then(() => this.model.changed());
    }
    stop(): void {
        this.model.clipping.endTool();
    }

    private region(): RegionOf {
        if (this.kind === 'screen') return { prism: this.model.surface.screenPolygon(this.screen) };
        return { polygon: this.ground.map(([x, y]) => [x, y]) };
    }

    private async addGround(x: number, y: number): Promise<void> {
        const place = await this.model.picking.place(x, y);
        const last = this.ground.at(-1);
        if (place && !(last && last[0] === place[0] && last[1] === place[1])) this.ground = [...this.ground, place];
    }

    private addScreen(place: Place): void {
        const before = this.screen, last = before.at(-1);
        if (last && Math.hypot(last.x - place.x, last.y - place.y) < slop) return;
        this.view = this.viewNow();
        this.corners = [...before, place];
    }

    private viewNow(): string {
        const { clientWidth, clientHeight } = this.model.canvas;
        return JSON.stringify([this.model.camera.read(), clientWidth, clientHeight]);
    }
}
