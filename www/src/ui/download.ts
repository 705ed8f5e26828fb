/** Has the browser keep something as a file. */
export function download(content: Blob, name: string): void {
    const address = URL.createObjectURL(content);
    follow(address, name);
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** Has it keep what is at an address; of another origin under the name that its server says. */
export function follow(address: string, name: string): void {
    const link = document.createElement('a');
    link.href = address;
    link.download = name;
    link.click();
}
