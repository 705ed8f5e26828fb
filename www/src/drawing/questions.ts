import { Said } from '../texts/said.ts';

/** What the program says to a question about a place of the picture. */
export interface Reply<T> {
    pending: boolean;
    value?: T | null;
    error?: string;
}

/**
 * The program answers one question at a time, frames later. Of a person's questions the newest counts, and older ones are answered
 * with null; what the page asks by itself waits while there is one, and gives way to it (undefined: not known).
 */
export class Questions {
    private last = 0;
    private open = 0;
    private isStopped = false;

    /** `begin` asks, `take` looks for the reply each frame. */
    async ask<T>(begin: () => void, take: () => Reply<T>): Promise<T | null> {
        if (this.isStopped) return null;
        const question = ++this.last;
        this.open++;
        try {
            begin();
            return (await this.reply(question, take)) ?? null;
        } finally {
            this.open--;
        }
    }

    /** For one asker at a time. */
    async askAside<T>(begin: () => void, take: () => Reply<T>): Promise<T | null | undefined> {
        while (this.open > 0) await frame();
        if (this.isStopped) return undefined;
        const question = this.last;
        begin();
        return this.reply(question, take);
    }

    /** Nobody answers any more. */
    stop(): void {
        this.isStopped = true;
    }

    private async reply<T>(question: number, take: () => Reply<T>): Promise<T | null | undefined> {
        for (;;) {
            await frame();
            if (this.isStopped || question !== this.last) return undefined; // another took its place
            const { pending, value, error } = take();
            if (error !== undefined) throw new Said(error);
            if (!pending) return value ?? null;
        }
    }
}

function frame(): Promise<number> {
    return new Promise((resolve) => requestAnimationFrame(resolve));
}
