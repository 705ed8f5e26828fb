// Two viewers on a page, made, drawn and disposed of, again and again: what is left of memory.
//   node tests/e2e/measure_disposal.mjs [ROUNDS] [--plain [PROGRAMS]]      after scripts/build_web.sh and scripts/build_package.sh; 100 rounds unless told
// --plain: two bare WebGL contexts instead, with as many bytes in buffers and a framebuffer, given back likewise: what the browser itself keeps;
// with PROGRAMS, each draws with so many different ones (1 unless told).
// Prints the page's JavaScript heap (collected) and the resident memory of the page's and the GPU's process. The page runs by
// itself and tells in its title how far it is: a debugger that listens to the network keeps what came of it.
import { spawn } from 'node:child_process';
import { mkdtemp, readdir, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { executable, flags } from './support/browser.mjs';
import { installPackage } from './support/embedding.mjs';

const rounds = Number(process.argv[2] ?? 100), isPlain = process.argv.includes('--plain');
const programs = isPlain ? Number(process.argv[process.argv.indexOf('--plain') + 1] ?? 1) : 0;

/** As the viewers draw: points from a buffer into a framebuffer with depth, then onto the canvas. */
const plain = `
const row = document.querySelector('.row');
for (let round = 1; round <= ${rounds}; round++) {
    const contexts = [60_000, 30_000].map((points) => {
        const canvas = document.createElement('canvas');
        Object.assign(canvas, { width: 420, height: 300 });
        row.append(canvas);
        const gl = canvas.getContext('webgl2', { antialias: false });
        const shader = (kind, text) => {
            const made = gl.createShader(kind);
            gl.shaderSource(made, '#version 300 es\\nprecision highp float;' + text);
            gl.compileShader(made);
            return made;
        };
        const made = Array.from({ length: ${programs} }, (_, i) => {
            const program = gl.createProgram();
            gl.attachShader(program, shader(gl.VERTEX_SHADER, 'in vec3 p; void main() { gl_Position = vec4(p, 1); gl_PointSize = 2.0; }'));
            gl.attachShader(program, shader(gl.FRAGMENT_SHADER, 'out vec4 c; void main() { c = vec4(' + (i + 1) + ') / ${programs}.0; }'));
            gl.bindAttribLocation(program, 0, 'p');
            gl.linkProgram(program);
            return program;
        });
        gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ARRAY_BUFFER, Float32Array.from({ length: 4 * points }, () => Math.random() - 0.5), gl.STATIC_DRAW);
        gl.enableVertexAttribArray(0);
        gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 16, 0);
        const texture = (format) => {
            const made = gl.createTexture();
            gl.bindTexture(gl.TEXTURE_2D, made);
            gl.texStorage2D(gl.TEXTURE_2D, 1, format, 420, 300);
            return made;
        };
        const frame = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture(gl.RGBA8), 0);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture(gl.DEPTH_COMPONENT24), 0);
        for (const program of made) {
            gl.useProgram(program);
            gl.drawArrays(gl.POINTS, 0, points);
        }
        gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
        gl.blitFramebuffer(0, 0, 420, 300, 0, 0, 420, 300, gl.COLOR_BUFFER_BIT, gl.NEAREST);
        if (gl.getError() !== 0) throw new Error('WebGL refuses');
        return gl;
    });
    for (let i = 0; i < 3; i++) await new Promise(requestAnimationFrame);
    for (const gl of contexts) gl.getExtension('WEBGL_lose_context').loseContext();
    row.replaceChildren();
    await new Promise((resolve) => setTimeout(resolve, 50));
    gc();
    document.title = round + ' ' + (performance.memory.usedJSHeapSize / 1e6).toFixed(2);
}`;

const script = isPlain ? plain : `
await customElements.whenDefined('stipple-viewer');
const row = document.querySelector('.row');
for (let round = 1; round <= ${rounds}; round++) {
    const viewers = ['town.stipple', 'other.stipple'].map((src) => {
        const viewer = document.createElement('stipple-viewer');
        viewer.setAttribute('src', src);
        viewer.setAttribute('controls', '');
        row.append(viewer);
        return viewer;
    });
    await Promise.all(viewers.map((viewer) => viewer.whenReady()));
    for (const viewer of viewers)
        do await viewer.settled();
        while (viewer.getClouds().some(({ stage }) => stage === 'opening'));
    viewers[0].dispose();
    row.replaceChildren();
    await new Promise((resolve) => setTimeout(resolve, 50));
    gc();
    document.title = round + ' ' + (performance.memory.usedJSHeapSize / 1e6).toFixed(2);
}`;

/** Resident bytes of the largest process of a kind below `parent`. */
async function residentMegabytes(parent, kind) {
    let most = 0;
    const parents = new Map();
    const kinds = new Map();
    for (const id of (await readdir('/proc')).filter((name) => /^\d+$/.test(name))) {
        const read = (name) => readFile(`/proc/${id}/${name}`, 'utf8').catch(() => '');
        const status = await read('status');
        parents.set(id, /PPid:\s+(\d+)/.exec(status)?.[1]);
        kinds.set(id, { command: await read('cmdline'), bytes: Number(/VmRSS:\s+(\d+)/.exec(status)?.[1] ?? 0) * 1024 });
    }
    for (const [id, { command, bytes }] of kinds) {
        let at = id;
        while (at && at !== String(parent)) at = parents.get(at);
        if (at && command.includes(`--type=${kind}`)) most = Math.max(most, bytes);
    }
    return Number((most / 1e6).toFixed(1));
}

const site = await installPackage();
await writeFile(join(site.folder, 'rounds.js'), script);
const html = await readFile(join(site.folder, 'empty.html'), 'utf8');
await writeFile(join(site.folder, 'rounds.html'), html.replace('</body>', '<script type="module" src="rounds.js"></script></body>'));
const profile = await mkdtemp(join(tmpdir(), 'stipple-disposal-'));
const own = ['--js-flags=--expose-gc', '--enable-precise-memory-info', '--remote-debugging-port=0', `--user-data-dir=${profile}`];
const browser = spawn(executable, [...flags, ...own, `${site.address}rounds.html`], { stdio: ['ignore', 'ignore', 'pipe'] });
const port = await new Promise((resolve, reject) => {
    browser.stderr.on('data', (chunk) => {
        const found = /DevTools listening on ws:\/\/127\.0\.0\.1:(\d+)/.exec(chunk);
        if (found) resolve(found[1]);
    });
    browser.once('exit', (code) => reject(new Error(`the browser ended with ${code}`)));
});

const step = Math.max(1, Math.floor(rounds / 10));
for (let done = 0; done < rounds; ) {
    await new Promise((resolve) => setTimeout(resolve, 250));
    const pages = await (await fetch(`http://127.0.0.1:${port}/json/list`)).json();
    const title = pages.find(({ url }) => url.endsWith('rounds.html'))?.title ?? '';
    const [round, heapMB] = title.split(' ').map(Number);
    if (!(heapMB > 0)) continue;
    const said = { round, heapMB };
    if (said.round === done || (said.round < done + step && said.round < rounds && said.round > 3)) continue;
    done = said.round;
    const [pageMB, gpuMB] = [await residentMegabytes(browser.pid, 'renderer'), await residentMegabytes(browser.pid, 'gpu-process')];
    console.log(JSON.stringify({ ...said, pageMB, gpuMB }));
}
const ended = new Promise((resolve) => browser.removeAllListeners('exit').once('exit', resolve));
browser.kill();
await ended;
await rm(profile, { recursive: true, force: true, maxRetries: 5 });
await site.close();
