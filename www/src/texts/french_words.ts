import { french as phrases } from './phrases/french.ts';
import { french as catalogue } from './french.ts';

/** All that is said in French, loaded together. */
export const french = { catalogue, phrases };
