import { japanese as phrases } from './phrases/japanese.ts';
import { japanese as catalogue } from './japanese.ts';

/** All that is said in Japanese, loaded together. */
export const japanese = { catalogue, phrases };
