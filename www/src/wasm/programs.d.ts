// The two programs that client/web builds, as Emscripten exports them. What they export is in program.ts.
declare module '@programs/*.mjs' {
    const create: (options: object) => Promise<unknown>;
    export default create;
}
declare module '@programs/*.wasm?url' {
    const url: string;
    export default url;
}
