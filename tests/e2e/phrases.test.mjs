// What the program says has a phrase in every language: of each pattern in its sources, and of no other. No browser is needed.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { describe, test } from 'node:test';

import { root } from './support/program.mjs';
import { saidPatterns, unsaid } from './support/said_patterns.mjs';

/** What the page itself gives the program to say (www/src/wasm/host.ts). */
const ofThePage = ['this machine is offline'];
const literal = /'(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*"/.source;

async function textOf(language) {
    return readFile(join(root, `www/src/texts/phrases/${language}.ts`), 'utf8');
}
const valueOf = (quoted) => quoted.slice(1, -1).replace(/\\(.)/g, '$1');
const valuesIn = (text) => [...text.matchAll(/\{\d\}/g)].map(([value]) => value).sort();

describe('phrases of the program', () => {
    test('the list of patterns is that of the sources', async () => {
        const listed = [...(await textOf('english')).matchAll(new RegExp(`^ {4}(${literal}),$`, 'gm'))].map(([, quoted]) => valueOf(quoted));
        const said = await saidPatterns();
        assert.ok(said.length > 250, `${said.length} patterns`);
        assert.deepEqual(listed, [...said, ...ofThePage].sort());
    });

    test('no error of the page’s programs has a sentence that is not said by its pattern', async () => {
        assert.deepEqual(await unsaid(), []);
    });

    test('values keep their places, also phrases within phrases', async () => {
        const { runnerImport } = await import(`${root}www/node_modules/vite/dist/node/index.js`);
        const load = async (name) => (await runnerImport(`./src/texts/${name}.ts`, { root: join(root, 'www'), configFile: false })).module;
        const { Said, sentenceOf } = await load('said'), { german } = await load('phrases/german');
        const said = "style\x1e'\x02sizePixels\x03' \x02must be a number from \x020.25\x03 to \x0264\x03\x03\x1etry again";
        assert.equal(new Said(said).message, "style: 'sizePixels' must be a number from 0.25 to 64 (try again)");
        assert.equal(sentenceOf(said, german), 'style: „sizePixels“ muss eine Zahl von 0.25 bis 64 sein (versuchen Sie es noch einmal)');
        assert.equal(sentenceOf('nobody knows \x02this\x03', german), 'nobody knows this');
    });

    for (const language of ['german', 'french', 'japanese'])
        test(`each has a phrase with its values in ${language}`, async () => {
            const text = await textOf(language);
            const phrases = [...text.matchAll(new RegExp(`^ {4}(${literal}): (${literal}),$`, 'gm'))].map((row) => row.slice(1).map(valueOf));
            assert.deepEqual(phrases.map(([pattern]) => pattern), [...(await saidPatterns()), ...ofThePage].sort());
            for (const [pattern, phrase] of phrases) assert.deepEqual(valuesIn(phrase), valuesIn(pattern), phrase);
        });
});
