// Formats, versions, conditions, absent things and rights, as the OpenAPI document of the running server has them.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { makeTown, scratchFolder, serve, stipple } from '../e2e/support/program.mjs';
import { Description, parameterText } from './description.mjs';

let folder, server, description, gets, access, token;

before(async () => {
    folder = await scratchFolder();
    access = `${folder.path}/access.json`;
    await makeTown(folder.path, { points: 5_000 });
    await makeTown(folder.path, { points: 3_000, name: 'plant' });
    await stipple('access', 'protect', access, 'plant');
    token = (await stipple('access', 'add', access, 'plant', '--name', 'Lisa', '--for', '1d')).match(/stp_\S+|\S{40,}/)[0];
    server = await serve(`${folder.path}/town.stipple`, `${folder.path}/plant.stipple`, '--access', access, '--metrics', 'local', '--pictures-per-minute', '0');
    description = await Description.of(server.address);
    gets = description.operations('get');
});
after(async () => {
    await server?.stop();
    await folder?.cleanUp();
});

const required = (one) => one.parameters.filter((p) => p.in === 'query' && p.required).map((p) => parameterText(p, p.example));
const queryOf = (one) => one.operation['x-example'] ?? required(one).join('&');
const withoutFormat = (query) => query.split('&').filter((part) => !part.startsWith('format=')).join('&');
const ofClouds = () => gets.filter((one) => one.path.startsWith('/api/v1/clouds/{id}'));

test('every media type that is described is given to who accepts it, and nothing to who accepts another', async () => {
    for (const one of gets.filter((other) => other.path.startsWith('/api/'))) {
        const types = Object.keys(one.operation.responses['200'].content);
        const query = withoutFormat(queryOf(one));
        for (const accept of types) {
            const answer = await description.ask(one, query, { headers: { accept } });
            assert.equal(answer.mediaType, accept, answer.what);
        }
        const other = await description.ask(one, query, { headers: { accept: 'video/mp4' } });
        assert.equal(other.status, types.length > 1 ? 406 : 200, other.what);
        if (other.status === 406) assert.deepEqual(other.json.available.toSorted(), types.toSorted());
    }
});

test('every format by name has a media type of its own', async () => {
    for (const one of gets) {
        const format = one.parameters.find((parameter) => parameter.name === 'format');
        if (!format) continue;
        const found = new Set();
        for (const name of format.schema.enum)
            found.add((await description.ask(one, `${withoutFormat(queryOf(one))}&format=${name}`)).mediaType);
        assert.deepEqual([...found].toSorted(), Object.keys(one.operation.responses['200'].content).toSorted());
    }
});

test('conditions are answered by 304 and 412, a version by what holds for ever, and another version by 410', async () => {
    const version = (await description.ask(gets.find((one) => one.operation.operationId === 'getCloud'))).json.version;
    for (const one of gets.filter((other) => other.path.startsWith('/api/'))) {
        const query = queryOf(one);
        const { headers } = await description.ask(one, query);
        const etag = headers.get('etag');
        assert.equal((await description.ask(one, query, { headers: { 'if-none-match': etag } })).status, 304);
        assert.equal((await description.ask(one, query, { headers: { 'if-match': '"other"' } })).status, 412);
        assert.equal((await description.ask(one, query, { headers: { 'if-match': etag } })).status, 200);
        if (!one.parameters.some((parameter) => parameter.name === 'version')) continue;
        const fixed = await description.ask(one, `${query}${query && '&'}version=${version}`);
        assert.match(fixed.headers.get('cache-control'), /immutable/, fixed.what);
        const gone = await description.ask(one, `${query}${query && '&'}version=1-2-3`);
        assert.equal(gone.status, 410, gone.what);
    }
});

test('what is held whole is answered in ranges, where that is described', async () => {
    for (const one of gets) {
        const hasRanges = '206' in one.operation.responses;
        const answer = await description.ask(one, queryOf(one), { headers: { range: 'bytes=1-2' } });
        assert.equal(answer.status, hasRanges ? 206 : 200, answer.what);
        if (!hasRanges) continue;
        assert.equal(answer.bytes.length, 2);
        const several = await description.ask(one, queryOf(one), { headers: { range: 'bytes=1-2, 3000-3001' } });
        assert.ok([200, 206].includes(several.status), several.what);
        assert.equal((await description.ask(one, queryOf(one), { headers: { range: 'bytes=99999999-' } })).status, 416);
    }
});

test('every type of problem says what it means', async () => {
    const one = gets.find((other) => other.operation.operationId === 'getProblemType');
    const types = description.document.components.schemas.Problem.properties.type.enum;
    const names = one.parameters.find((parameter) => parameter.name === 'name').schema.enum;
    assert.deepEqual(types, names.map((name) => `/api/v1/problems/${name}`));
    for (const name of names) {
        const answer = await description.ask(one, '', { names: { name } });
        assert.equal(answer.json.type, `/api/v1/problems/${name}`);
    }
});

test('absent nodes and malformed keys are problems', async () => {
    for (const one of ofClouds().filter((other) => other.path.includes('{key}'))) {
        assert.equal((await description.ask(one, '', { names: { key: '9-1-1-1' } })).json.type, '/api/v1/problems/no-such-node');
        for (const key of ['1', '0-0-0-1', '00-0-0-0', 'x-0-0-0', '1-0-0-0-0'])
            assert.equal((await description.ask(one, '', { names: { key } })).status, 400);
    }
});

test('a private cloud opens with a token or a signature, and else is as one that is absent', async () => {
    const signed = (await stipple('access', 'sign', access, 'plant', '--for', '1h')).match(/expires=\d+&signature=[\w-]+/)[0];
    const bearer = { authorization: `Bearer ${token}` };
    for (const one of ofClouds()) {
        const query = queryOf(one);
        assert.deepEqual(one.operation.security, [{}, { bearer: [] }, { expires: [], signature: [] }]);
        const names = { id: 'plant' };
        const refused = await description.ask(one, query, { names });
        const absent = await description.ask(one, query, { names: { id: 'nothing' } });
        assert.equal(refused.status, 401, refused.what);
        assert.deepEqual({ ...refused.json, instance: '' }, { ...absent.json, instance: '' });
        assert.equal((await description.ask(one, query, { names, headers: { authorization: 'Bearer x' } })).status, 401);
        assert.equal((await description.ask(one, query, { names: { id: 'nothing' }, headers: bearer })).status, 403);
        for (const answer of [
            await description.ask(one, query, { names, headers: bearer }),
            await description.ask(one, query ? `${query}&${signed}` : signed, { names }),
        ]) {
            assert.equal(answer.status, 200, answer.what);
            assert.match(answer.headers.get('cache-control'), /private/);
        }
    }
});
