// What ssim.js makes of the sample pictures must be what measures.json holds, and so what our own gives
// (tests/unit/client/measure). `node check_ssim.mjs`; exit code 1 if not.
import { readFile } from 'node:fs/promises';
import ssimModule from 'ssim.js';
import { picture } from './pictures.mjs';

const measures = JSON.parse(await readFile(new URL('measures.json', import.meta.url)));
const base = picture('base', true);
let failed = 0;
for (const [name, { ssim: expected }] of Object.entries(measures.pairs)) {
  const { mssim } = ssimModule.default(base, picture(name, true), { ssim: 'original', downsample: false });
  const equal = Math.abs(mssim - expected) < 1e-12;
  console.log(`${name}: ssim.js ${mssim}, measures.json ${expected}${equal ? '' : ': DIFFERENT'}`);
  failed += equal ? 0 : 1;
}
console.log(`${Object.keys(measures.pairs).length - failed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
