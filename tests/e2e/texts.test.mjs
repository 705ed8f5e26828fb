// The catalogues of the page's texts: all have every message, with the same values in it. (That they do is also checked
// as types, where they are written; this is what a person who edits them by other means runs into.)
import assert from 'node:assert/strict';
import { readdir, readFile } from 'node:fs/promises';
import { before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';

const www = fileURLToPath(new URL('../../www/', import.meta.url));
const languages = { de: 'german', fr: 'french', ja: 'japanese' };
const catalogues = {};

before(async () => {
    const { runnerImport } = await import(`${www}node_modules/vite/dist/node/index.js`);
    const load = async (name) => (await runnerImport(`./src/texts/${name}.ts`, { root: www, configFile: false })).module;
    catalogues.en = (await load('english')).english;
    for (const [language, name] of Object.entries(languages)) catalogues[language] = (await load(name))[name];
    catalogues.texts = await load('texts');
});

const forms = (message) => (typeof message === 'string' ? { other: message } : message);
const values = (text) => [...new Set(text.match(/\{\w+\}/g) ?? [])].sort();

describe('texts', () => {
    for (const language of Object.keys(languages))
        test(`${language} has every message, with its values and its plural forms`, () => {
            const { en, [language]: other } = catalogues;
            assert.deepEqual(Object.keys(other).sort(), Object.keys(en).sort());
            const categories = new Intl.PluralRules(language).resolvedOptions().pluralCategories;
            for (const [key, message] of Object.entries(en)) {
                const needed = values(forms(message).other);
                for (const [form, text] of Object.entries(forms(other[key]))) {
                    assert.ok(categories.includes(form), `${key}: ${language} has no plural form ${form}`);
                    assert.notEqual(text.trim(), '', key);
                    const missing = needed.filter((value) => !text.includes(value));
                    // 'Click a point' needs no number.
                    assert.deepEqual(missing.filter((value) => form === 'other' || value !== '{count}'), [], `${key}.${form}`);
                    assert.deepEqual(values(text).filter((value) => !needed.includes(value)), [], `${key}.${form}`);
                }
                // 'many' is of French millions alone, which 'other' may stand for.
                if (typeof message !== 'string')
                    for (const form of categories) assert.ok(form === 'many' || form in forms(other[key]), `${key}.${form}`);
            }
        });

    test('a catalogue is not English with another name', () => {
        for (const language of Object.keys(languages)) {
            const same = Object.entries(catalogues.en).filter(
                ([key, message]) => JSON.stringify(message) === JSON.stringify(catalogues[language][key]) && !/^[\W\d]*\{?\w*\}?[\W]*$/.test(message),
            );
            assert.ok(same.length < 12, `${language}: ${same.map(([key]) => key).join(', ')}`);
        }
    });

    test('numbers, plurals and languages are those of the person', () => {
        const { bestLanguage, Texts } = catalogues.texts;
        assert.deepEqual(bestLanguage(['pt-BR', 'fr-CA', 'en']), { language: 'fr', locale: 'fr-CA' });
        assert.deepEqual(bestLanguage(['xx', '']), { language: 'en', locale: 'en' });
        assert.deepEqual(bestLanguage(['de_AT']), { language: 'de', locale: 'de-AT' });
        const [en, de, fr] = ['en', 'de', 'fr'].map((language) => new Texts(language, language, catalogues[language]));
        assert.equal(en.decimals(1234.5, 2), '1234.50');
        assert.equal(de.decimals(1234.5, 2), '1234,50');
        assert.equal(en.number(0.1), '0.1');
        assert.equal(de.number(-636400.125), '-636400,125');
        assert.equal(en.text('page.points', { count: 1, shown: '1' }), '1 point');
        assert.equal(de.text('measure.hintPoints', { count: 3 }), '3 Punkte anklicken; Escape bricht ab.');
        assert.equal(fr.text('profile.state', { count: 0, state: 'x' }), '0 point, x'); // French: 0 is singular
        assert.equal(fr.bytes(3 * 1024 * 1024), '3,0 Mio');
        assert.equal(de.translated('class', 'Ground'), 'Boden');
        assert.equal(de.translated('class', 'A class of my own'), 'A class of my own');
    });

    test('elements say nothing that is not in the catalogues', async () => {
        const folder = `${www}src/ui/`;
        for (const file of await readdir(folder)) {
            const source = (await readFile(folder + file, 'utf8')).replace(/css`[^`]*`/g, '').replace(/\/\*.*?\*\/|\/\/.*$/gms, '');
            const attributes = source.match(/\b(aria-label|title|placeholder)="[A-Z][a-z]+[^"]*"/g) ?? [];
            const contents = (source.match(/[^=]>\s*([A-Z][a-z]{2,}[^<>${}`]*)(?=<|\$)/g) ?? []).filter((text) => !/Stipple|JSON/.test(text));
            assert.deepEqual([...attributes, ...contents], [], file);
        }
    });
});
