import { german as phrases } from './phrases/german.ts';
import { german as catalogue } from './german.ts';

/** All that is said in German, loaded together. */
export const german = { catalogue, phrases };
