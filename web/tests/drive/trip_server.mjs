// A server for tests: the built page, and what docs/reference/recorder.md asks of a server.
import { createHash } from 'node:crypto';
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';

const types = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.png': 'image/png',
  '.webmanifest': 'application/manifest+json',
};

// invitations: whose tokens alone are taken; empty: all may send. trips: the bodies that were acknowledged, by hash; fates: what
// became of them, by hash. mood.next: what befalls the next PUT ('lose_answer', a status, or undefined); mood.token: POSTs
// ('lose_answer'); mood.hold: a promise for which answers to a PUT wait.
export async function serveTrips(folder, { invitations = [] } = {}) {
  const trips = new Map();
  const owners = new Map();
  const fates = new Map();
  const tokens = new Map(); // the one token of each invitation
  const spent = new Set(); // invitations that can be exchanged no more
  const asked = [];
  const sentTypes = [];
  const mood = { next: undefined, token: undefined, hold: undefined };
  const fateOf = (sha256) => ({
    sha256, state: 'queued', received: '2026-05-01T08:00:00Z', bytes: trips.get(sha256)?.length, trips: 0, passes: 0, ...fates.get(sha256),
  });
  const taken = (name) => { const value = mood[name]; mood[name] = undefined; return value; };

  function exchange(text, send) {
    if (!invitations.includes(text) || spent.has(text)) {
      send(401, { detail: 'the invitation was accepted before, has expired or is none' });
      return;
    }
    tokens.set(text, `token-${asked.length}-of-${invitations.indexOf(text)}`);
    if (mood.token === 'lose_answer') {
      send(502, { title: 'bad gateway' }); // as a proxy says that lost it
    } else {
      send(201, { token: tokens.get(text) });
    }
  }

  async function put(request, sha256, body, owner, send) {
    if (typeof mood.next === 'number') {
      send(taken('next'), { title: 'not now' }, { 'Retry-After': '1' });
      return;
    }
    if (createHash('sha256').update(body).digest('hex') !== sha256) {
      send(422, { detail: 'the hash differs' });
      return;
    }
    const status = trips.has(sha256) ? 200 : 202;
    trips.set(sha256, body);
    owners.set(sha256, owner);
    sentTypes.push(request.headers['content-type']);
    await mood.hold;
    if (taken('next') === 'lose_answer') {
      send(502, { title: 'bad gateway' }, { 'Retry-After': '1' });
    } else {
      send(status, fateOf(sha256), { Location: `/v1/trips/${sha256}` });
    }
  }

  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, 'http://x');
    asked.push(`${request.method} ${pathname}`);
    const [, sha256] = /^\/v1\/trips\/([0-9a-f]{64})$/.exec(pathname) ?? [];
    const send = (status, body, headers = {}) =>
      response.writeHead(status, { 'Content-Type': 'application/json', ...headers }).end(body && JSON.stringify(body));
    if (!pathname.startsWith('/v1/')) {
      const file = join(folder, normalize(pathname.endsWith('/') ? `${pathname}index.html` : pathname));
      if (!file.startsWith(folder) || !existsSync(file) || !statSync(file).isFile()) {
        send(404, { title: 'not found' });
        return;
      }
      response.writeHead(200, { 'Content-Type': types[extname(file)] ?? 'application/octet-stream' });
      createReadStream(file).pipe(response);
      return;
    }
    const chunks = [];
    request.on('data', (chunk) => chunks.push(chunk)).on('end', () => {
      const text = request.headers.authorization?.replace('Bearer ', '');
      const owner = invitations.length === 0 ? '' : invitations.find((invitation) => text && tokens.get(invitation) === text);
      const isOwn = trips.has(sha256) && owners.get(sha256) === owner;
      if (pathname === '/v1/tokens') {
        exchange(text, send);
      } else if (owner === undefined) {
        send(401, { title: 'token needed' }, { 'WWW-Authenticate': 'Bearer' });
      } else if (pathname === '/v1/trips') {
        send(200, { trips: [...trips.keys()].filter((hash) => owners.get(hash) === owner).reverse().map(fateOf) });
      } else if (request.method === 'PUT') {
        put(request, sha256, Buffer.concat(chunks), owner, send);
      } else if (!isOwn) {
        send(404, { title: 'not found' });
      } else if (request.method === 'GET') {
        send(200, fateOf(sha256));
      } else {
        trips.delete(sha256);
        send(204);
      }
    });
  });
  await new Promise((ready) => { server.listen(0, '127.0.0.1', ready); });
  server.unref(); // a test that fails before it closes the server must not keep the process
  return {
    url: `http://127.0.0.1:${server.address().port}/drive/`, trips, owners, fates, tokens, spent, asked, sentTypes, mood,
    close: () => { server.closeAllConnections(); server.close(); },
  };
}
