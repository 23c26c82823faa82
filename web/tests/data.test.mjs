// What the page asks a server for while its database changes.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { openSite } from '../src/data.js';

// Versions of a site, each with its files of segments; addresses of any but the latest are gone.
const versions = [
  [['1+0000', '1+0001'], ['1-0000', '2+0000'], ['2+0001', '10+0000']],
  [['1+0000', '1+0001', '1-0000'], ['1-0001'], ['2+0000', '2+0001'], ['10+0000', '11+0000']],
  [['11+0000']],
];
let latest = 0;

function answer(path) {
  const [, file, version] = /^([^?]+)(?:\?v=(\d+))?$/.exec(path);
  const files = versions[latest];
  if (file === 'site.json') return { segments: { index: `segments/index.json?v=${latest}`, url: `segments/{shard}.json?v=${latest}` } };
  if (Number(version) !== latest) return null;
  if (file === 'segments/index.json') return files.map(([first]) => first);
  return Object.fromEntries(files[/\d+/.exec(file)[0]].map((segment) => [segment, { segment, version: latest }]));
}

const { fetch } = globalThis;
before(() => {
  globalThis.fetch = async (path) => {
    const json = answer(path);
    return json ? Response.json(json) : new Response('', { status: 410 });
  };
});
after(() => { globalThis.fetch = fetch; });

describe('all segments', () => {
  test('come once each, in their order, from the latest version where it changes meanwhile', async () => {
    const { segments } = await openSite();
    const found = [];
    for await (const rows of segments()) {
      found.push(...rows.map(({ segment, version }) => `${version}:${segment}`));
      if (found.length === 4) latest = 1;
    }
    assert.deepEqual(found, ['0:1+0000', '0:1+0001', '0:1-0000', '0:2+0000', '1:2+0001', '1:10+0000', '1:11+0000']);
  });

  test('end where the latest version has no more', async () => {
    const { segments } = await openSite();
    const found = [];
    for await (const rows of segments()) {
      found.push(...rows.map(({ segment }) => segment));
      latest = 2;
    }
    assert.deepEqual(found, ['1+0000', '1+0001', '1-0000', '11+0000']);
  });
});
