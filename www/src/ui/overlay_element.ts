import { css, type CSSResult } from 'lit';

import { followPointer } from './follow_pointer.ts';
import { ModelElement } from './model_element.ts';

/** Something that lies over the picture, under the panels, and follows the camera. Clicks go through it, but where it says otherwise. */
export abstract class OverlayElement extends ModelElement {
    static overlayStyles: CSSResult = css`
        :host {
            position: absolute;
            inset: 0;
            pointer-events: none;
            overflow: hidden;
            z-index: -1;
        }
        :focus-visible {
            outline: 2px solid var(--accent);
            outline-offset: 2px;
        }
        svg {
            width: 100%;
            height: 100%;
            display: block;
            touch-action: none; /* of handles; browsers do not heed it on what lies in an svg */
        }
    `;

    override connectedCallback(): void {
        super.connectedCallback();
        this.model.addEventListener('frame', this.follow);
    }
    override disconnectedCallback(): void {
        this.model.removeEventListener('frame', this.follow);
        super.disconnectedCallback();
    }

    /** Calls `follow` as the pointer goes on that went down on a handle, until it is lifted. */
    followPointer(event: PointerEvent, follow: (moved: PointerEvent) => void): void {
        event.preventDefault();
        event.stopPropagation();
        followPointer(event, follow);
    }
}
