// A decoding worker: runs client/web/decoder_exports.cpp on the jobs that it is sent, one after the other.
import createDecoder from '@programs/stipple_decoder.mjs';

import { type FromDecoder, nodeArrayCount, type ToDecoder } from './decoder_messages.ts';
import { Heap } from './heap.ts';
import type { DecoderProgram, ProgramOptions } from './program.ts';

const scope = self as unknown as {
    onmessage: ((event: MessageEvent<ToDecoder>) => void) | null;
    postMessage(message: FromDecoder, transfer: Transferable[]): void;
};

let decoder: { program: DecoderProgram; heap: Heap } | undefined;
const early: ToDecoder[] = []; // came before the program was there

async function start(compiled: WebAssembly.Module): Promise<void> {
    const options: ProgramOptions = {
        instantiateWasm: (imports, receive) => {
            void WebAssembly.instantiate(compiled, imports).then(receive);
            return {};
        },
    };
    const program = (await createDecoder(options)) as DecoderProgram;
    decoder = { program, heap: new Heap(program) };
    early.splice(0).forEach(handle);
}

function decode(job: number, parts: Uint8Array[], program: DecoderProgram, heap: Heap): void {
    const sizes = parts.map((part) => part.length);
    const messageSize = heap.lend(parts, (message, picture, attributes) =>
        program._stipple_decode(message!, sizes[0]!, picture!, sizes[1]!, attributes!, sizes[2]!),
    );
    const message = heap.copy(program._stipple_answer_message(), messageSize);
    const arrays = Array.from({ length: nodeArrayCount }, (_, index) =>
        heap.copy(program._stipple_answer_array(index), program._stipple_answer_array_size(index)),
    );
    scope.postMessage(
        { kind: 'decoded', job, message, arrays },
        arrays.map((array) => array.buffer),
    );
}

function handle(message: ToDecoder): void {
    if (message.kind === 'program') {
        void start(message.program);
        return;
    }
    if (!decoder) {
        early.push(message);
        return;
    }
    const { program, heap } = decoder;
    switch (message.kind) {
        case 'describe':
            heap.lend([message.description], (at) =>
                program._stipple_describe_cloud(message.cloud, at!, message.description.length),
            );
            break;
        case 'forget':
            program._stipple_forget_cloud(message.cloud);
            break;
        case 'decode':
            try {
                decode(message.job, [message.message, message.picture, message.attributes], program, heap);
            } catch (error) {
                scope.postMessage({ kind: 'failed', job: message.job, detail: String(error) }, []);
            }
    }
}

scope.onmessage = (event) => handle(event.data);
