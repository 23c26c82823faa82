// Requests drawn at random from the OpenAPI definition of a running server: none is answered by a 5xx, and each body fits the
// schema that the definition gives it.
import Ajv from 'ajv';
import fc from 'fast-check';
import { createConfig, lintFromString } from '@redocly/openapi-core';
import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { Agent, get } from 'node:http';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { openSite } from '../src/data.js';
import { served } from './served.mjs';
import { databaseIn, macadam } from './simulated.mjs';

let api, server, folder, url, database;
const problem = { type: 'object', required: ['title', 'status', 'detail'], properties: { title: { type: 'string' }, status: { type: 'integer' }, detail: { type: 'string' } } };
const agent = new Agent({ keepAlive: true, maxSockets: 4 });

const ask = (target) => new Promise((resolve, reject) => {
  get(url + target, { agent }, (response) => {
    const parts = [];
    response.on('data', (part) => parts.push(part));
    response.on('end', () => resolve({ status: response.statusCode, type: response.headers['content-type'] ?? '', body: Buffer.concat(parts).toString() }));
  }).on('error', reject);
});

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

// ------------------------------------------------------------------------------------ requests

const hostile = ['', "'", "';DROP TABLE segment--", '%', '../..', '\u0000', '<script>', 'NaN', '1e999', '-0', '9'.repeat(400), 'é'.repeat(50), '(((((((((((((((((((((((((', '{"op":"', '1,2,3', '-1', '\\', '"', '%zz', '..'];
const comparison = fc.tuple(fc.constantFrom('iri', 'passes', 'name', 'class', 'last_seen', 'geometry', 'none'), fc.constantFrom('=', '<>', '<', '>=', ' LIKE ', ' IN (', ' BETWEEN '), fc.constantFrom('4', "'poor'", "DATE('2026-05-01')", "'a%')", '1) ', '1 AND 2', 'POINT(16 48)', 'iri + 1')).map((words) => words.join(''));
const place = fc.tuple(fc.constantFrom('S_INTERSECTS', 'S_WITHIN', 'S_CROSSES', 'S_EQUALS', 'T_DURING'), fc.constantFrom('BBOX(15,48,16,49)', 'POINT(15.6 48.4)', 'POLYGON((15 48,16 48,16 49,15 48))', "INTERVAL('2026-01-01','..')", 'GEOMETRYCOLLECTION(POINT(1 1))')).map(([name, shape]) => `${name}(geometry,${shape})`);
const filter = fc.array(fc.oneof(comparison, place), { minLength: 1, maxLength: 4 }).chain((parts) => fc.constantFrom(' AND ', ' OR ', ' AND NOT ').map((word) => parts.join(word)));

function valueOf({ name, schema }) {
  const fitting = schema.enum ? fc.constantFrom(...schema.enum)
    : name === 'filter' ? filter
      : schema.type === 'integer' ? fc.integer({ min: schema.minimum ?? 0, max: Math.min(schema.maximum ?? 50, 50) })
        : schema.type === 'number' ? fc.double({ noNaN: true })
          : schema.type === 'array' ? fc.array(fc.double({ min: -180, max: 180, noNaN: true }), { minLength: 4, maxLength: 4 }).map((numbers) => numbers.join())
            : fc.constantFrom('2026-05-01', '2026-03-01/..', 'poor', 'residential', 'http://www.opengis.net/def/crs/EPSG/0/4326', '1', '15.6,48.4');
  return fc.oneof({ weight: 4, arbitrary: fitting }, { weight: 1, arbitrary: fc.constantFrom(...hostile) }, { weight: 1, arbitrary: fc.string() });
}

function requests() {
  const each = Object.entries(api.paths).filter(([, path]) => path.get && !path.get.security).map(([pattern, { get: operation }]) => {
    const parameters = operation.parameters ?? [];
    const inPath = parameters.filter((parameter) => parameter.in === 'path');
    const query = parameters.filter((parameter) => parameter.in === 'query');
    return [pattern, fc.tuple(
      fc.tuple(...inPath.map(valueOf)),
      query.length ? fc.subarray(query, { maxLength: Math.min(4, query.length) }).chain((chosen) => fc.tuple(...chosen.map((parameter) => valueOf(parameter).map((value) => [parameter.name, value])))) : fc.constant([]),
    ).map(([words, pairs]) => {
      const path = inPath.reduce((text, { name }, i) => text.replace(`{${name}}`, encodeURIComponent(words[i])), pattern);
      const text = new URLSearchParams(pairs.map(([name, value]) => [name, String(value)])).toString();
      return { pattern, operation, target: text ? `${path}?${text}` : path };
    })];
  });
  return fc.oneof(...each.map(([pattern, arbitrary]) => ({ weight: pattern.endsWith('/items') ? 15 : 1, arbitrary })));
}

describe('the API', { timeout: 300_000 }, () => {
  test('answers 2,000 random requests as its definition says', async () => {
    const ajv = new Ajv({ strict: false, validateFormats: false });
    ajv.addSchema({ $id: 'api', components: api.components });
    const validators = new Map();
    const validatorOf = (schema) => {
      const key = JSON.stringify(schema).replaceAll('"#/', '"api#/');
      if (!validators.has(key)) validators.set(key, ajv.compile(JSON.parse(key)));
      return validators.get(key);
    };
    const statuses = new Map();
    await fc.assert(fc.asyncProperty(requests(), async ({ pattern, operation, target }) => {
      const { status, type, body } = await ask(target);
      statuses.set(status, (statuses.get(status) ?? 0) + 1);
      assert.ok(status < 500, `${status} ${target}: ${body.slice(0, 300)}`);
      if (status === 204 || !type.includes('json')) return;
      const schema = status < 300 ? Object.values(operation.responses['200'].content)[0].schema : problem;
      const validate = validatorOf(schema);
      assert.ok(validate(JSON.parse(body)), `${pattern} ${target}: ${JSON.stringify(validate.errors)}`);
    }), { numRuns: 2000, seed: 21 });
    assert.ok(statuses.get(200) > 300 && statuses.get(400) > 100, JSON.stringify([...statuses])); // both are drawn
  });

  test('is defined as OpenAPI asks', async () => {
    const config = await createConfig({ extends: ['minimal'] });
    const problems = await lintFromString({ source: JSON.stringify(api), config });
    assert.deepEqual(problems.filter(({ severity }) => severity === 'error').map(({ message, location }) => `${message} ${location[0]?.pointer}`), []);
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
