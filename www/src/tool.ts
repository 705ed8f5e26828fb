/** What is in hand: clicks on the picture, and the keys that end or mend a drawing, are its own. */
export interface Tool {
    /** At a place of the canvas, in CSS pixels. Clicks are answered frames later, one after the other. */
    click(x: number, y: number): void;
    /** Keeps what is drawn, once earlier clicks have their points. */
    finishInTurn(): void;
    /** The last point, likewise. */
    takeBackInTurn(): void;
    /** Puts it away, and what is drawn. */
    stop(): void;
    /** Where the space bar clicks, and arrow keys move it; none: the middle of the picture, and they move the camera. */
    readonly cursor?: { x: number; y: number };
    moveCursor?(dx: number, dy: number): void;
}
