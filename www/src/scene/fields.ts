import { Problem } from '../texts/message.ts';

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
            throw new Problem('scene.mustBeObject', { place: path || 'scene' });
        return new FieldReader(value as Record<string, unknown>, path);
    }

    text(name: string, fallback: string, most = 1000): string {
        const value = this.take(name);
        if (value === undefined) return fallback;
        if (typeof value !== 'string' || value.length > most)
            throw new Problem('scene.mustBeText', { place: this.placeOf(name), most });
        return value as string;
    }
    flag(name: string, fallback: boolean): boolean {
        const value = this.take(name);
        if (value === undefined) return fallback;
        if (typeof value !== 'boolean') throw new Problem('scene.mustBeFlag', { place: this.placeOf(name) });
        return value as boolean;
    }
    number(name: string, fallback: number, isRight: (value: number) => boolean = () => true): number {
        const value = this.take(name);
        if (value === undefined) return fallback;
        if (typeof value !== 'number' || !Number.isFinite(value) || !isRight(value))
            throw new Problem('scene.mustBeNumber', { place: this.placeOf(name) });
        return value as number;
    }
    vector(name: string, isRight: (value: number) => boolean = () => true): [number, number, number] {
        return readPlace(this.take(name), this.placeOf(name), isRight);
    }
    oneOf<T extends string>(name: string, options: readonly T[], fallback?: T): T {
        const value = this.take(name);
        if (value === undefined && fallback !== undefined) return fallback;
        if (!options.includes(value as T))
            throw new Problem('scene.mustBeOneOf', { place: this.placeOf(name), options: options.join(', ') });
        return value as T;
    }
    object(name: string): Record<string, unknown> {
        const value = this.take(name);
        if (value === undefined) return {};
        if (typeof value !== 'object' || value === null || Array.isArray(value))
            throw new Problem('scene.mustBeObject', { place: this.placeOf(name) });
        return value as Record<string, unknown>;
    }
    optionalObject(name: string): Record<string, unknown> | undefined {
        return Object.hasOwn(this.source, name) ? this.object(name) : undefined;
    }
    list<T>(name: string, most: number, read: (item: unknown, path: string) => T): T[] {
        const value = this.take(name);
        if (value === undefined) return [];
        if (!Array.isArray(value) || value.length > most)
            throw new Problem('scene.mustBeList', { place: this.placeOf(name), most });
        return (value as unknown[]).map((item, index) => read(item, `${this.placeOf(name)}[${index}]`));
    }
    /** To be called last: a field that nobody asked for is a mistake, or of a later version. */
    finish(): void {
        for (const name of this.unread) throw new Problem('scene.unknownField', { place: this.placeOf(name) });
    }

    private take(name: string): unknown {
        this.unread.delete(name);
        return Object.hasOwn(this.source, name) ? this.source[name] : undefined;
    }
    private placeOf(name: string): string {
        return this.path ? `${this.path}.${name}` : name;
    }
}

/** Three numbers. */
export function readPlace(value: unknown, path: string, isRight: (value: number) => boolean = () => true): [number, number, number] {
    const isOne = Array.isArray(value) && value.length === 3 && value.every((n) => Number.isFinite(n) && isRight(n));
    if (!isOne) throw new Problem('scene.mustBeVector', { place: path });
    return value as [number, number, number];
}
