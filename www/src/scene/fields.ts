/** Reads fields of JSON that may come from anybody: each has a type and a limit, and what is wrong is said by its name. */
export class FieldReader {
    private readonly unread: Set<string>;

    constructor(
        private readonly source: Record<string, unknown>,
        private readonly path: string,
    ) {
        this.unread = new Set(Object.keys(source));
    }

    static of(value: unknown, path: string): FieldReader {
        if (typeof value !== 'object' || value === null || Array.isArray(value))
            throw new Error(`${path || 'The scene'} must be an object {…}.`);
        return new FieldReader(value as Record<string, unknown>, path);
    }

    text(name: string, fallback: string, most = 1000): string {
        const value = this.take(name);
        if (value === undefined) return fallback;
        if (typeof value !== 'string' || value.length > most) this.fail(name, `a text of at most ${most} characters`);
        return value as string;
    }
    flag(name: string, fallback: boolean): boolean {
        const value = this.take(name);
        if (value === undefined) return fallback;
        if (typeof value !== 'boolean') this.fail(name, 'true or false');
        return value as boolean;
    }
    number(name: string, fallback: number, isRight: (value: number) => boolean = () => true): number {
        const value = this.take(name);
        if (value === undefined) return fallback;
        if (typeof value !== 'number' || !Number.isFinite(value) || !isRight(value)) this.fail(name, 'a number that fits');
        return value as number;
    }
    vector(name: string, isRight: (value: number) => boolean = () => true): [number, number, number] {
        const value = this.take(name);
        const isOne = Array.isArray(value) && value.length === 3 && value.every((n) => Number.isFinite(n) && isRight(n));
        if (!isOne) this.fail(name, 'three numbers [x, y, z]');
        return value as [number, number, number];
    }
    oneOf<T extends string>(name: string, options: readonly T[], fallback?: T): T {
        const value = this.take(name);
        if (value === undefined && fallback !== undefined) return fallback;
        if (!options.includes(value as T)) this.fail(name, `one of ${options.join(', ')}`);
        return value as T;
    }
    object(name: string): Record<string, unknown> {
        const value = this.take(name);
        if (value === undefined) return {};
        if (typeof value !== 'object' || value === null || Array.isArray(value)) this.fail(name, 'an object {…}');
        return value as Record<string, unknown>;
    }
    optionalObject(name: string): Record<string, unknown> | undefined {
        return Object.hasOwn(this.source, name) ? this.object(name) : undefined;
    }
    list<T>(name: string, most: number, read: (item: unknown, path: string) => T): T[] {
        const value = this.take(name);
        if (value === undefined) return [];
        if (!Array.isArray(value) || value.length > most) this.fail(name, `a list of at most ${most}`);
        return (value as unknown[]).map((item, index) => read(item, `${this.placeOf(name)}[${index}]`));
    }
    /** To be called last: a field that nobody asked for is a mistake, or of a later version. */
    finish(): void {
        for (const name of this.unread) throw new Error(`${this.placeOf(name)} is not a field of a scene.`);
    }

    private take(name: string): unknown {
        this.unread.delete(name);
        return Object.hasOwn(this.source, name) ? this.source[name] : undefined;
    }
    private placeOf(name: string): string {
        return this.path ? `${this.path}.${name}` : name;
    }
    private fail(name: string, wanted: string): never {
        throw new Error(`${this.placeOf(name)} must be ${wanted}.`);
    }
}
