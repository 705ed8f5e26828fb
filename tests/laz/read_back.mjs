// node read_back.mjs FOLDER: reads each NAME.laz there with laz-perf; its points must be the bytes of NAME.records.
import assert from 'node:assert/strict';
import { readdir, readFile } from 'node:fs/promises';
import { join, parse } from 'node:path';
import { createLazPerf } from 'laz-perf';

const folder = process.argv[2];
const lazPerf = await createLazPerf();

function decode(file) {
  const bytes = lazPerf._malloc(file.length);
  lazPerf.HEAPU8.set(file, bytes);
  const laz = new lazPerf.LASZip();
  laz.open(bytes, file.length);
  const count = laz.getCount();
  const length = laz.getPointLength();
  const points = new Uint8Array(count * length);
  const point = lazPerf._malloc(length);
  for (let i = 0; i < count; ++i) {
    laz.getPoint(point);
    points.set(lazPerf.HEAPU8.subarray(point, point + length), i * length);
  }
  lazPerf._free(point);
  laz.delete();
  lazPerf._free(bytes);
  return { count, length, points };
}

let files = 0;
for (const name of (await readdir(folder)).filter((n) => n.endsWith('.laz')).sort()) {
  const { count, length, points } = decode(await readFile(join(folder, name)));
  const expected = await readFile(join(folder, `${parse(name).name}.records`));
  assert.equal(points.length, expected.length, `${name}: ${count} points of ${length} bytes`);
  const differs = points.findIndex((byte, at) => byte !== expected[at]);
  assert.equal(differs, -1, `${name}: point ${Math.floor(differs / length)}, byte ${differs % length}`);
  ++files;
}
assert.notEqual(files, 0, `no LAZ files in ${folder}`);
console.log(`laz-perf read ${files} files`);
