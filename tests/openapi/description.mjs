// The document as tests look at it: its operations with references followed, addresses that it describes, and whether
// an answer is one of those that it describes.
import assert from 'node:assert/strict';
import Ajv2020 from 'ajv/dist/2020.js';

const problemType = 'application/problem+json';
const documentId = 'https://stipple.example/openapi.json'; // for references; never asked for

/** What a value of a parameter object looks like in an address. */
export function parameterText(parameter, value) {
    return `${parameter.name}=${encodeURIComponent(Array.isArray(value) ? value.join(',') : value)}`;
}

export class Description {
    constructor(address, document) {
        this.address = address;
        this.document = document;
        this.ajv = new Ajv2020({ strict: true, allowUnionTypes: true, strictRequired: false, strictTypes: false });
        this.ajv.addKeyword('components');
        this.ajv.addSchema({ $id: documentId, components: { schemas: document.components.schemas } });
    }

    static async of(address) {
        const answer = await fetch(new URL('api/v1/openapi.json', address));
        assert.equal(answer.status, 200);
        return new Description(address, await answer.json());
    }

    resolve(object) {
        if (!object?.$ref) return object;
        return object.$ref.slice(2).split('/').reduce((at, name) => at[name], this.document);
    }

    /** {path, method, operation, parameters}, one for each. */
    operations(method) {
        const found = [];
        for (const [path, item] of Object.entries(this.document.paths))
            if (item[method])
                found.push({
                    path,
                    method,
                    operation: item[method],
                    parameters: [...(item.parameters ?? []), ...(item[method].parameters ?? [])],
                });
        return found;
    }

    /** An address of the path, with what stands for its {…} and a query. */
    url(path, query = '', names = {}) {
        const filled = path.replace(/\{(\w+)\}/g, (_, name) => names[name] ?? { id: 'town', key: '0-0-0-0', name: 'not-found' }[name]);
        assert.doesNotMatch(filled, /[{}]|undefined/);
        return new URL(query ? `${filled}?${query}` : filled, this.address);
    }

    /** Asks, and checks that status, fields, media type and JSON are what the operation describes. */
    async ask(one, query = '', { names, headers = {} } = {}) {
        const url = this.url(one.path, query, names);
        const answer = await fetch(url, { method: one.method.toUpperCase(), headers });
        const bytes = Buffer.from(await answer.arrayBuffer());
        const what = `${one.method} ${url} → ${answer.status} ${bytes.subarray(0, 300)}`;
        const described = this.resolve(one.operation.responses[answer.status]);
        assert.ok(described, `the status is not described: ${what}`);
        for (const [name, field] of Object.entries(described.headers ?? {}))
            if (field.required) assert.ok(answer.headers.has(name), `${name} is missing: ${what}`);
        const mediaType = answer.headers.get('content-type')?.split(';')[0];
        let json;
        if (one.method === 'head' || answer.status === 304) {
            assert.equal(bytes.length, 0, what);
        } else {
            const content = described.content?.[mediaType];
            assert.ok(content, `${mediaType} is not described: ${what}`);
            if (content.schema) {
                json = JSON.parse(bytes);
                this.check(json, one, answer.status, mediaType, content.schema, what);
            }
        }
        if (mediaType === problemType && json) {
            assert.equal(json.status, answer.status, what);
            assert.equal(json.instance, url.pathname, what);
        }
        return { status: answer.status, headers: answer.headers, mediaType, bytes, json, what };
    }

    check(json, one, status, mediaType, schema, what) {
        const key = `${one.path} ${status} ${mediaType}`;
        let validate = this.ajv.getSchema(key);
        if (!validate) {
            const absolute = JSON.parse(JSON.stringify(schema).replaceAll('"$ref":"#/', `"$ref":"${documentId}#/`));
            this.ajv.addSchema(absolute, key);
            validate = this.ajv.getSchema(key);
        }
        assert.ok(validate(json), `${JSON.stringify(validate.errors?.slice(0, 3))}: ${what}`);
    }
}
