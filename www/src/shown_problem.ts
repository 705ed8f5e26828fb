/**
 * `stopped`: nothing more comes until somebody does something. `retrying`: it is tried again by itself. `incomplete`: a
 * part of the cloud is given up, the rest is shown.
 */
export type ProblemKind = 'stopped' | 'retrying' | 'incomplete';

/** Something that is wrong, and what can be done. */
export interface ShownProblem {
    /** Of the cloud, or the server. */
    name: string;
    kind: ProblemKind;
    /** What happened. */
    sentence: string;
    /** What to do about it; may be empty. */
    advice: string;
    /** A token was given, and did not help. */
    tokenWasRefused: boolean;
    /** Sends that token to the server from now on, and tries again; there where one may help. */
    giveToken?(token: string): void;
    retry(): void;
    /** One of both: gives the cloud up, or does not show the problem any more. */
    close?(): void;
    hide?(): void;
}
