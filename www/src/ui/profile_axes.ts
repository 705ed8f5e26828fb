import { svg, type SVGTemplateResult } from 'lit';

import type { ProfilePoints } from '../profile/profile_points.ts';
import { margin, type ProfileView, ticks, toPixels, toProfile } from '../profile/profile_view.ts';

/** Stations along the foot of the view, heights along its left. */
export function axes(view: ProfileView): SVGTemplateResult[] {
    const corner = toProfile(view, margin.left, view.height - margin.bottom);
    const end = toProfile(view, view.width - margin.right, margin.top);
    const stations = ticks(corner.station, end.station, 1 / view.scale);
    const heights = ticks(corner.height, end.height, 1 / view.scale / view.exaggeration, 30);
    const bottom = view.height - margin.bottom, right = view.width - margin.right;
    return [
        ...stations.map((station) => {
            const { x } = toPixels(view, station, 0);
            return svg`<line class="grid" x1=${x} x2=${x} y1=${bottom} y2=${bottom + 5}></line>
                <text x=${x} y=${bottom + 18} text-anchor="middle">${station}</text>`;
        }),
        ...heights.map((height) => {
            const { y } = toPixels(view, 0, height);
            return svg`<line class="grid" x1=${margin.left - 5} x2=${margin.left} y1=${y} y2=${y}></line>
                <text x=${margin.left - 8} y=${y + 4} text-anchor="end">${height}</text>`;
        }),
        svg`<path class="grid" fill="none" d=${`M${margin.left} ${margin.top}V${bottom}H${right}`}></path>`,
    ];
}

/** Around a point; nothing where there is no such. */
export function mark(view: ProfileView, points: ProfilePoints, index: number): SVGTemplateResult | '' {
    if (index < 0 || index >= points.count) return '';
    const { x, y } = toPixels(view, points.station[index]!, points.height[index]!);
    return svg`<circle class="mark" cx=${x} cy=${y} r="5"></circle>`;
}

/** What is seen, as an SVG file: points as a picture in it. */
export function pictureOf(view: ProfileView, canvas: HTMLCanvasElement, axes: Element): Blob {
    const style = `text{font:11px sans-serif;fill:#333}.grid{stroke:#999;fill:none}.mark{fill:none;stroke:#087;stroke-width:2}`;
    const content = new XMLSerializer().serializeToString(axes).replace(/^<svg[^>]*>|<\/svg>$/g, '').replace(/<!--.*?-->/gs, '');
    const text = `<svg xmlns="http://www.w3.org/2000/svg" width="${view.width}" height="${view.height}" viewBox="0 0 ${view.width} ${view.height}">
<style>${style}</style><rect width="100%" height="100%" fill="#fff"/>
<image href="${canvas.toDataURL('image/png')}" width="${view.width}" height="${view.height}"/>
${content}</svg>\n`;
    return new Blob([text], { type: 'image/svg+xml' });
}
