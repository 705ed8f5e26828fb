import type { Model } from '../model.ts';
import type { Tool } from '../tool.ts';

/** Stands in hand for a tool that is still being loaded: what is done with it is done with the tool once that is there. */
export class ComingTool implements Tool {
    readonly cursor: { x: number; y: number };
    private readonly steps: ((tool: Tool) => void)[] = [];

    constructor(
        private readonly model: Model,
        private readonly hasCursor: boolean,
    ) {
        const { clientWidth, clientHeight } = model.canvas;
        this.cursor = { x: clientWidth / 2, y: clientHeight / 2 };
    }

    get moveCursor(): ((dx: number, dy: number) => void) | undefined {
        if (!this.hasCursor) return undefined;
        return (dx, dy) => {
            this.cursor.x += dx;
            this.cursor.y += dy;
            this.steps.push((tool) => tool.moveCursor?.(dx, dy));
        };
    }
    click(x: number, y: number): void {
        this.steps.push((tool) => tool.click(x, y));
    }
    finishInTurn(): void {
        this.steps.push((tool) => tool.finishInTurn());
    }
    takeBackInTurn(): void {
        this.steps.push((tool) => tool.takeBackInTurn());
    }
    stop(): void {
        this.model.clipping.endTool();
    }

    replay(tool: Tool): void {
        for (const step of this.steps) step(tool);
    }
}
