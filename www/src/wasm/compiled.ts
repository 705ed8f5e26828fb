const programs = new Map<string, Promise<WebAssembly.Module>>();

/** The program at `url`, fetched and compiled once for all viewers of a page; a failure is tried again by the next that asks. */
export function compiledOnce(url: string): Promise<WebAssembly.Module> {
    const known = programs.get(url);
    if (known) return known;
    const program = compile(url);
    programs.set(url, program);
    program.catch(() => programs.delete(url));
    return program;
}

async function compile(url: string): Promise<WebAssembly.Module> {
    const response = await fetch(url);
    if (!response.ok) throw new Error(`${url}: status ${response.status}`);
    // Hosts that do not know application/wasm can't have it compiled as it arrives.
    return response.headers.get('content-type')?.startsWith('application/wasm')
        ? WebAssembly.compileStreaming(response)
        : WebAssembly.compile(await response.arrayBuffer());
}
