import { html, render } from 'lit';

import { followDrops, followInput } from './input.ts';
import { Model } from './model.ts';
import { fromFragment, isSceneFragment } from './scene/share_link.ts';
import { listClouds, type CloudPage } from './server_clouds.ts';
import { installTestHook } from './test_hook.ts';
import { loadTexts, Texts } from './texts/texts.ts';
import type { App } from './ui/app.ts';
import './ui/app.ts';

async function start(): Promise<void> {
    const list = listClouds(); // travels while the program loads
    list.catch(() => {}); // told by the model
    const texts = await loadTexts([...new URLSearchParams(location.search).getAll('lang'), ...navigator.languages]);
    const canvas = document.createElement('canvas');
    canvas.tabIndex = 0;
    document.documentElement.lang = texts.locale;
    canvas.setAttribute('aria-label', texts.text('page.canvas'));
    document.body.append(canvas);

    const model = await Model.create(canvas, texts);
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
        model.tell(error);
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
    const texts = new Texts();
    box.textContent = texts.text('page.cannotStart', { reason: texts.sentenceOf(error) });
    document.body.replaceChildren(box);
}

start().catch(explain);
