// The running server against the OpenAPI document that it serves: what is described is so, what is so is described.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Validator } from '@seriousme/openapi-schema-validator';
import { makeTown, scratchFolder, serve } from '../e2e/support/program.mjs';
import { Description, parameterText } from './description.mjs';

let folder, server, description, gets;

before(async () => {
    folder = await scratchFolder();
    await makeTown(folder.path, { points: 40_000 });
    server = await serve(`${folder.path}/town.stipple`, '--metrics', 'local', '--pictures-per-minute', '0');
    description = await Description.of(server.address);
    gets = description.operations('get');
});
after(async () => {
    await server?.stop();
    await folder?.cleanUp();
});

const isOfApi = (one) => one.path.startsWith('/api/');
const queryParameters = (one) => one.parameters.filter((parameter) => parameter.in === 'query');
const example = (one) => one.operation['x-example'] ?? '';

/** A query that the operation answers, without one parameter: what it needs is there. */
function queryBeside(one, parameter) {
    const needed = parameter['x-needs'];
    const parts = new Map((needed ?? example(one)).split('&').filter(Boolean).map((part) => [part.split('=')[0], part]));
    for (const other of queryParameters(one))
        if (other.required && !parts.has(other.name)) parts.set(other.name, parameterText(other, other.example));
    if (needed) // the formats and limits of the example keep answers small
        for (const part of example(one).split('&'))
            if (/^(format|limit|width|height|budget)=/.test(part)) parts.set(part.split('=')[0], part);
    parts.delete(parameter.name);
    return [...parts.values()];
}
const withParameter = (one, parameter, text) => [...queryBeside(one, parameter), text].join('&');

test('the document is valid OpenAPI 3.1, and its references lead somewhere', async () => {
    const validator = new Validator();
    const result = await validator.validate(structuredClone(description.document));
    assert.ok(result.valid, JSON.stringify(result.errors));
    assert.equal(validator.version, '3.1');
    for (const [, reference] of JSON.stringify(description.document).matchAll(/"\$ref":"([^"]+)"/g))
        assert.ok(description.resolve({ $ref: reference }), reference);
    const names = description.operations('get').concat(description.operations('head')).map((one) => one.operation.operationId);
    assert.equal(new Set(names).size, names.length);
});

test('every path answers as it is described, and its head with the same fields', async () => {
    for (const one of gets) {
        const answer = await description.ask(one, example(one) || queryParameters(one).filter((p) => p.required).map((p) => parameterText(p, p.example)).join('&'));
        assert.equal(answer.status, 200, answer.what);
        const head = description.operations('head').find((other) => other.path === one.path);
        assert.equal(head !== undefined, isOfApi(one));
        if (!head) continue;
        const fields = await description.ask(head, example(one));
        for (const name of ['content-type', 'etag', 'cache-control'])
            assert.equal(fields.headers.get(name), answer.headers.get(name), answer.what);
    }
});

test('what is not described is not there', async () => {
    for (const path of ['/api/v1', '/api/v1/', '/api/v1/nothing', '/api/v1/clouds/town/nothing', '/api/v1/clouds/town/', '/api/v2/clouds'])
        assert.equal((await fetch(new URL(path, server.address))).status, 404, path);
});

test('parameters that are not described are refused everywhere', async () => {
    for (const one of gets.filter(isOfApi)) {
        const answer = await description.ask(one, 'colour=red');
        assert.equal(answer.status, 400, answer.what);
        assert.equal(answer.json.type, '/api/v1/problems/unknown-parameter', answer.what);
        assert.equal(answer.json.parameter, 'colour');
    }
});

test('the example of every parameter works, and what is usual is what comes without it', async () => {
    let tried = 0;
    for (const one of gets)
        for (const parameter of queryParameters(one)) {
            if (parameter.example !== undefined) {
                const answer = await description.ask(one, withParameter(one, parameter, parameterText(parameter, parameter.example)));
                assert.equal(answer.status, 200, answer.what);
                ++tried;
            } else {
                assert.equal(parameter.name, 'version'); // which no document can know
            }
            if (parameter.schema.default !== undefined) {
                const usual = await description.ask(one, withParameter(one, parameter, parameterText(parameter, parameter.schema.default)));
                const without = await description.ask(one, queryBeside(one, parameter).join('&'));
                assert.equal(usual.status, 200, usual.what);
                assert.ok(usual.bytes.equals(without.bytes), `${parameter.name} is not ${parameter.schema.default}: ${without.what}`);
            }
        }
    assert.ok(tried > 60);
});

/** Texts that the schema of a parameter excludes. */
function wrongTexts({ schema }) {
    const wrong = [''];
    const types = { integer: ['1.5', '-1', 'x', '0x10', '1e2'], number: ['x', '1,2', 'nan', 'inf', '+1', '1e999'], array: ['x', '1,', '1,2,3,4,5,6,7,8', 'nan'] };
    wrong.push(...(types[schema.type] ?? []));
    if (schema.enum) wrong.push('no-such-choice', schema.enum[0].toUpperCase());
    if (schema.minimum !== undefined && schema.type === 'integer') wrong.push(String(schema.minimum - 1));
    if (schema.maximum !== undefined) wrong.push(schema.type === 'integer' ? String(BigInt(schema.maximum) + 1n) : String(schema.maximum * 2));
    if (schema.pattern) {
        assert.doesNotMatch('???', new RegExp(schema.pattern));
        wrong.push('???');
    }
    return wrong;
}

test('values that the schemas exclude are refused, naming the parameter', async () => {
    for (const one of gets.filter(isOfApi))
        for (const parameter of queryParameters(one)) {
            for (const text of wrongTexts(parameter)) {
                const answer = await description.ask(one, withParameter(one, parameter, `${parameter.name}=${encodeURIComponent(text)}`));
                assert.equal(answer.status, 400, answer.what);
                assert.equal(answer.json.type, '/api/v1/problems/invalid-parameter', answer.what);
                assert.equal(answer.json.parameter, parameter.name, answer.what);
            }
            const right = parameterText(parameter, parameter.example ?? 'x');
            const twice = await description.ask(one, `${withParameter(one, parameter, right)}&${right}`);
            assert.equal(twice.status, 400, twice.what);
            assert.equal(twice.json.parameter, parameter.name);
            if (parameter.required) {
                const missing = await description.ask(one, queryBeside(one, parameter).join('&'));
                assert.equal(missing.json.type, '/api/v1/problems/missing-parameter', missing.what);
                assert.equal(missing.json.parameter, parameter.name);
            }
        }
});

test('every choice, every number of numbers and every limit that the schemas allow is taken', async () => {
    for (const one of gets.filter(isOfApi))
        for (const parameter of queryParameters(one)) {
            const { schema, name } = parameter;
            const texts = [...(schema.enum ?? [])];
            if (schema.type === 'integer' || schema.type === 'number') texts.push(schema.minimum, schema.maximum);
            for (const form of schema.oneOf ?? []) texts.push([1, 2, 3, 4, 5, 6].slice(0, form.minItems).join(','));
            for (const text of texts) {
                const answer = await description.ask(one, withParameter(one, parameter, `${name}=${encodeURIComponent(text)}`));
                // A limit may be too much for this server or this cloud; then it says that, and not what the schema says.
                if (answer.status !== 200) {
                    assert.equal(answer.status, 400, answer.what);
                    assert.ok(schema.type === 'integer' || schema.type === 'number' || schema.type === 'array', answer.what);
                    assert.doesNotMatch(answer.json.detail, /is no |is out of range|give a number from|it has \d+ numbers/, answer.what);
                }
            }
        }
});
