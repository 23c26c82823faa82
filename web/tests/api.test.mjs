// Requests drawn at random from the OpenAPI definition of a running server: none is answered by a 5xx, and each body fits the
// schema that the definition gives it.
import Ajv from 'ajv';
import fc from 'fast-check';
import { createConfig, lintFromString } from '@redocly/openapi-core';
import { Validator } from '@seriousme/openapi-schema-validator';
import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { Agent, request } from 'node:http';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { openSite } from '../src/data.js';
import { requests } from './random_requests.mjs';
import { served } from './served.mjs';
import { databaseIn, macadam } from './simulated.mjs';

let api, server, folder, url, database;
const problem = { type: 'object', required: ['title', 'status', 'detail'], properties: { title: { type: 'string' }, status: { type: 'integer' }, detail: { type: 'string' } } };
const agent = new Agent({ keepAlive: true, maxSockets: 4 });

const ask = (target, { url: at = url, method = 'GET', headers = {}, sent } = {}) => new Promise((resolve, reject) => {
  request(at + target, { agent, method, headers }, (response) => {
    const parts = [];
    response.on('data', (part) => parts.push(part));
    response.on('end', () => resolve({ status: response.statusCode, type: response.headers['content-type'] ?? '', body: Buffer.concat(parts).toString() }));
  }).on('error', reject).end(sent);
});

// Validators of the schemas of the definition, each made once.
function validators() {
  const ajv = new Ajv({ strict: false, validateFormats: false });
  ajv.addSchema({ $id: 'api', components: api.components });
  const made = new Map();
  return (schema) => {
    const key = JSON.stringify(schema).replaceAll('"#/', '"api#/');
    if (!made.has(key)) made.set(key, ajv.compile(JSON.parse(key)));
    return made.get(key);
  };
}

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'macadam-api-'));
  database = databaseIn(folder);
  server = await served(database);
  url = server.url;
  api = JSON.parse((await ask('/api')).body);
}, { timeout: 300_000 });

after(() => {
  agent.destroy();
  server?.close();
  rmSync(folder, { recursive: true, force: true });
});

describe('the API', { timeout: 300_000 }, () => {
  test('answers 2,000 random requests as its definition says', async () => {
    const crowd = databaseIn(mkdtempSync(join(folder, 'crowd-')));
    macadam('privacy', crowd, 'crowd'); // takes trips of contributors, too
    const server = await served(crowd, '--workers', '0', '--behind-proxy', 'http://roads.example');
    const kept = () => macadam('info', crowd, '--digest');
    try {
      const before = kept();
      const tokens = Object.fromEntries([['anna', 'upload'], ['ben', 'upload'], ['reader', 'read'], ['office', 'operator']].map(([name, scope]) => [name, macadam('token', 'create', crowd, name, '--scope', scope).trim().split('\n').pop()]));
      for (const name of ['cleo', 'dora']) tokens[`invited ${name}`] = /mac_\w+/.exec(macadam('token', 'invite', crowd, name, '--url', 'https://roads.example'))[0];
      const validatorOf = validators();
      const seen = new Map();
      const count = (name) => seen.set(name, (seen.get(name) ?? 0) + 1);
      let client = 0;
      const property = fc.asyncProperty(requests(api, tokens), fc.boolean(), async ({ pattern, operation, method, target, headers, body: sent }, own) => {
        client += 1; // another each time, of whom none asks too often
        const of = { 'X-Forwarded-For': `10.${client >> 16}.${(client >> 8) & 255}.${client & 255}`, ...headers };
        const { status, type, body } = await ask(target, { url: own && operation && !operation.security ? url : server.url, method, headers: of, sent });
        count(status);
        if (operation?.security) count(`${method} ${status}`);
        const said = `${method} ${target} ${status}: ${body.slice(0, 300)}`;
        assert.ok(status < 500, said);
        const isOfPath = new RegExp(`^${pattern.replaceAll('.', '\\.').replaceAll(/\{\w+\}/g, '[^/?]+')}(\\?|$)`).test(target); // words can lead elsewhere
        assert.ok(operation ? operation.responses[status] || (status >= 400 && !isOfPath) : status >= 400, `${said} is not in the definition`);
        if (!body || !type.includes('json')) return;
        const schema = status < 300 ? Object.values(operation.responses[status].content)[0].schema : problem;
        const validate = validatorOf(schema);
        assert.ok(validate(JSON.parse(body)), `${said} ${JSON.stringify(validate.errors)}`);
      });
      for (const [seed, numRuns] of [[21, 667], [2026, 667], [43, 666]]) await fc.assert(property, { numRuns, seed });
      const drawn = JSON.stringify([...seen]);
      for (const [name, least] of [[200, 300], [400, 100], ['PUT 202', 10], ['PUT 200', 5], ['PUT 422', 5], ['PUT 415', 2], ['PUT 401', 10], ['PUT 403', 5], ['GET 200', 10], ['GET 404', 10], ['DELETE 204', 5], ['DELETE 404', 10], ['DELETE 401', 10], ['POST 201', 2]]) assert.ok((seen.get(name) ?? 0) >= least, `${name}: ${drawn}`);
      assert.equal(kept(), before);
    } finally {
      server.close();
    }
  });

  test('is defined as OpenAPI asks', async () => {
    const config = await createConfig({ extends: ['minimal'] });
    const problems = await lintFromString({ source: JSON.stringify(api), config });
    assert.deepEqual(problems.filter(({ severity }) => severity === 'error').map(({ message, location }) => `${message} ${location[0]?.pointer}`), []);
    const { valid, errors } = await new Validator().validate(structuredClone(api));
    assert.ok(valid, JSON.stringify(errors));
  });
});

describe('the data of a page that was opened before a change', { timeout: 300_000 }, () => {
  test('is that of one version, the newer one from the next question on', async () => {
    const copies = join(folder, 'changing');
    for (const file of readdirSync(join(database, '..')).filter((name) => /^roads\.gpkg/.test(name) && !/wal|shm|uploads/.test(name))) cpSync(join(database, '..', file), join(copies, file));
    const copy = join(copies, 'roads.gpkg');
    const live = await served(copy);
    const { fetch: ask } = globalThis;
    globalThis.fetch = (path) => ask(new URL(path, live.url)); // as relative to a page
    try {
      await live.waitFor('/site.json');
      const { site, segment } = await openSite();
      const { digest, segments: { index } } = site;
      macadam('forget', copy, '--trip', readdirSync(join(dirname(process.env.MACADAM_WEB_DATABASE ?? database), 'fleet/trips'))[0]);
      while ((await (await fetch('/site.json')).json()).digest === digest) await new Promise((resolve) => { setTimeout(resolve, 200); });
      assert.equal((await fetch(`/${index}`)).status, 410);
      assert.equal((await fetch('/assets/maplibre-gl-worker.mjs?v=6.17.0')).status, 200); // as the library asks for it
      const left = JSON.parse(macadam('query', copy, '--bbox', '-180,-90,180,90', '--json')).filter(({ passes }) => passes > 0);
      assert.ok(left.length > 100);
      for (const one of left.filter((_, i) => i % 50 === 0)) assert.equal((await segment(one.segment)).passes, one.passes, one.segment);
      assert.notEqual(site.digest, digest);
      const answer = await fetch(`/${site.segments.index}`);
      assert.match(answer.headers.get('Cache-Control'), /immutable/);
    } finally {
      globalThis.fetch = ask;
      live.close();
    }
  });
});
