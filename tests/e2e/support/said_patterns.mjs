// The patterns of all sentences that the page's programs may say: the calls of say() (shared/base/phrase.hpp) in their sources.
import { readdir, readFile } from 'node:fs/promises';
import { join } from 'node:path';

import { root } from './program.mjs';

/** What the programs are made of, and files in there that write clouds or files, which the page does not. */
const folders = ['client/core', 'client/render', 'client/survey', 'client/region', 'client/web', 'shared'];
const others = /^shared\/(cli|las|sinks)\/|^shared\/base\/work_gate|\/(cloud_writer|node_encoder|file_writing|output_file|scratch_file|byte_sink)\.cpp$/;
const quoted = /^\s*(?:"(?:[^"\\]|\\.)*"\s*)+$/s;

/** Sorted; `{0}`, `{1}` … stand for values. */
export async function saidPatterns() {
    const patterns = new Set();
    for (const { text } of await sources()) for (const pattern of patternsIn(text)) patterns.add(pattern);
    return [...patterns].sort();
}

/** Places of the sources where an error has a sentence that is not said so: {file, text}. */
export async function unsaid() {
    const all = await sources();
    const shared = phraseTakers(all.filter(({ file }) => file.endsWith('.hpp')));
    const found = [];
    for (const source of all) {
        const tell = (part) => part && isUnsaid(part) && found.push({ file: source.file, text: part.trim() });
        for (const { index, 0: code } of source.text.matchAll(/ErrorCode::\w+,/g)) {
            const [what, , advice] = argumentsAt(source.text, index + code.length);
            [what, advice].forEach(tell);
        }
        for (const [name, places] of [...shared, ...phraseTakers([source])])
            for (const { index, 0: call } of source.text.matchAll(new RegExp(`\\b${name}\\(`, 'g'))) {
                const given = argumentsAt(source.text, index + call.length);
                places.forEach((place) => tell(given[place]));
            }
        for (const [text] of source.text.matchAll(/\b(?:std::string(?:_view)?&?|char\*) (?:what|advice|expected)\b[^;]*?\)\s*(?:const\s*)?\{\s*return (?:Error)?\{ErrorCode::\w+,\s*(?:what|advice|expected)\b/g))
            found.push({ file: source.file, text }); // a sentence that is no phrase on its way
    }
    return found;
}

const isUnsaid = (part) => (quoted.test(part) || /^\s*cat\(/.test(part)) && !/^\s*""\s*$/.test(part);

/** Functions that take phrases, and at which places: [["wrong", [1]], …]. */
function phraseTakers(all) {
    const takers = [];
    for (const { text } of all)
        for (const { index, 0: open } of text.matchAll(/\b\w+(?: = \[&\])?\(/g)) {
            const name = /^\w+/.exec(open)[0];
            if (!/^[^(){};"]*\bPhrase&? \w+/.test(text.slice(index + open.length, index + open.length + 200))) continue;
            const taken = argumentsAt(text, index + open.length);
            const places = taken.flatMap((part, place) => (/^\s*(?:const )?Phrase&? \w+/.test(part) ? [place] : []));
            if (places.length > 0 && !/^(?:addTo|Phrase|addValue)$/.test(name)) takers.push([name, places]);
        }
    return takers;
}

async function sources() {
    const files = [];
    for (const folder of folders)
        for (const name of await readdir(join(root, folder), { recursive: true }))
            if (/\.(cpp|hpp)$/.test(name) && !others.test(`${folder}/${name}`)) files.push(join(folder, name));
    return Promise.all(files.map(async (file) => ({ file, text: await readFile(join(root, file), 'utf8') })));
}

function* patternsIn(text) {
    for (const { index, 0: call } of text.matchAll(/\bsay\(/g)) {
        if (/\/\/[^\n]*$/.test(text.slice(0, index)) || /Phrase\s+$/.test(text.slice(0, index))) continue; // told about; defined
        let values = 0;
        yield argumentsAt(text, index + call.length)
            .map((part) => (quoted.test(part) ? textOf(part) : `{${values++}}`))
            .join('');
    }
    for (const [, literals] of text.matchAll(/constexpr const char\* (?:\w+Advice|timeoutText) =\s*((?:"(?:[^"\\]|\\.)*"\s*)+);/g))
        yield textOf(literals);
}

/** The arguments from `at` up to the bracket that closes them. */
function argumentsAt(text, at) {
    const parts = [];
    let depth = 0, from = at;
    for (let i = at; ; i++) {
        const c = text[i];
        if (c === undefined) throw new Error(`a bracket is not closed: ${text.slice(at, at + 60)}`);
        if (c === '"' || c === "'") {
            for (i++; text[i] !== c; i++) if (text[i] === '\\') i++;
        } else if ('([{'.includes(c)) depth++;
        else if (')]}'.includes(c) && depth-- === 0) {
            parts.push(text.slice(from, i));
            return parts;
        } else if (c === ',' && depth === 0) {
            parts.push(text.slice(from, i));
            from = i + 1;
        }
    }
}

function textOf(literals) {
    return [...literals.matchAll(/"((?:[^"\\]|\\.)*)"/g)].map(([, inner]) => inner.replace(/\\(.)/g, '$1')).join('');
}
