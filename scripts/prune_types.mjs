// Deletes the declaration files of a folder that an entry does not lead to, and ends with an error if one leads out of it.
//   node scripts/prune_types.mjs FOLDER ENTRY
import { readdir, readFile, rm } from 'node:fs/promises';
import { dirname, join, normalize } from 'node:path';

const [folder, entry] = process.argv.slice(2);
const reached = new Set();

async function follow(file) {
    if (reached.has(file)) return;
    reached.add(file);
    const text = await readFile(join(folder, file), 'utf8');
    for (const [, from] of text.matchAll(/(?:from|import)\s*\(?\s*'([^']+)'/g)) {
        if (!from.startsWith('.')) throw new Error(`${file} needs ${from}, which the package does not bring`);
        await follow(normalize(join(dirname(file), from)).replace(/\.ts$/, '.d.ts'));
    }
}

await follow(entry);
for (const item of await readdir(folder, { recursive: true, withFileTypes: true })) {
    const path = join(item.parentPath, item.name);
    if (item.isFile() && !reached.has(path.slice(folder.length + 1))) await rm(path);
}
