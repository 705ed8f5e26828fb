import { html, render } from 'lit';

import { followDrops, followInput } from './input.ts';
import { messageOf } from './messages.ts';
import { Model } from './model.ts';
import { fromFragment, isSceneFragment } from './scene/share_link.ts';
import { listClouds, type CloudPage } from './server_clouds.ts';
import { installTestHook } from './test_hook.ts';
import type { App } from './ui/app.ts';
import './ui/app.ts';

async function start(): Promise<void> {
    const list = listClouds(); // travels while the program loads
    list.catch(() => {}); // told by the model
    const canvas = document.createElement('canvas');
    canvas.tabIndex = 0;
    canvas.setAttribute(
        'aria-label',
        'Point cloud. Arrow keys turn, shift and arrow keys move, plus and minus zoom, 1, 2, 3 and 4 show top, front, iso and side, F shows all, U goes back.',
    );
    document.body.append(canvas);

    const model = await Model.create(canvas);
    installTestHook(model);
    followInput(canvas, model);
    const layer = document.createElement('div');
    document.body.append(layer);
    render(html`<stipple-app .model=${model}></stipple-app>`, layer);
    const app = layer.querySelector<App>('stipple-app')!;
    followDrops(model, (isOver) => (app.isDropTarget = isOver));

    addEventListener('hashchange', () => void openLinkedScene(model));
    if (!(await openLinkedScene(model))) await openClouds(model, list);
    else await model.takeList(list);
}

/** The scene in the address's fragment, if there is one. */
async function openLinkedScene(model: Model): Promise<boolean> {
    if (!isSceneFragment(location.hash)) return false;
    try {
        model.scenes.open(await fromFragment(location.hash));
        return true;
    } catch (error) {
        model.notify(messageOf(error));
        return false;
    }
}

/** Those that the address names (`?cloud=URL`, several times if need be), else the server's first. */
async function openClouds(model: Model, list: Promise<CloudPage>): Promise<void> {
    const named = new URLSearchParams(location.search).getAll('cloud');
    named.forEach((address) => model.openAddress(address));
    await model.takeList(list);
    const first = model.listed[0];
    if (named.length === 0 && first) model.openAddress(first.address, first.name);
}

function explain(error: unknown): void {
    const box = document.createElement('p');
    box.className = 'failure';
    box.setAttribute('role', 'alert');
    box.textContent = `Stipple can't start: ${messageOf(error)}`;
    document.body.replaceChildren(box);
}

start().catch(explain);
