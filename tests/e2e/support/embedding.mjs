// The packed element in a page of its own, as somebody who installs it has it: npm, a static host, a strict policy.
import { execFile } from 'node:child_process';
import { readdir, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';

import { makeTown, scratchFolder } from './program.mjs';
import { serveFolder } from './static_host.mjs';

const root = fileURLToPath(new URL('../../..', import.meta.url));
export const run = promisify(execFile);

/** The policy that www/package/README.md promises to work with. */
export const policy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self'";

const page = (body) => `<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Embedding</title>
<link rel="icon" href="icon.svg"><link rel="stylesheet" href="page.css">
<script type="module" src="node_modules/stipple-viewer/dist/stipple-viewer.js"></script></head><body>${body}</body></html>`;

const style = `body { margin: 0; font-size: 16px } stipple-viewer { width: 420px; height: 300px; margin: 4px }
.row { display: flex } .tall { width: 800px; height: 560px }`;

/** {address, folder, close()}: town.stipple and other.stipple, index.html with two viewers, empty.html with none. */
export async function installPackage() {
    const folder = await scratchFolder();
    const [packed] = (await readdir(join(root, 'build/package'))).filter((name) => name.endsWith('.tgz'));
    await writeFile(join(folder.path, 'package.json'), '{"name": "embedding", "private": true}');
    await run('npm', ['install', '--offline', '--no-audit', '--no-fund', '--silent', join(root, 'build/package', packed)], { cwd: folder.path });
    await makeTown(folder.path, { points: 60_000 });
    await makeTown(folder.path, { points: 30_000, seed: 3, name: 'other' });
    const two = `<h1>Two viewers</h1><div class="row"><stipple-viewer id="a" src="town.stipple"></stipple-viewer>
<stipple-viewer id="b" src="other.stipple" controls lang="de" theme="light" budget="20000"></stipple-viewer></div><button>After</button>`;
    await writeFile(join(folder.path, 'index.html'), page(two));
    await writeFile(join(folder.path, 'empty.html'), page('<div class="row"></div>'));
    await writeFile(join(folder.path, 'page.css'), style);
    await writeFile(join(folder.path, 'icon.svg'), '<svg xmlns="http://www.w3.org/2000/svg"/>');
    const host = await serveFolder(folder.path, { 'content-security-policy': policy });
    const close = async () => {
        await host.close();
        await folder.cleanUp();
    };
    return { address: host.address, folder: folder.path, close };
}
