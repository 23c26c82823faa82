// A server for tests: the built page, and `PUT /v1/trips/{sha256}` as docs/reference/recorder.md describes it.
import { createHash } from 'node:crypto';
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';

const types = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.png': 'image/png',
  '.webmanifest': 'application/manifest+json',
};

// trips: the bodies that were acknowledged, by hash. mood.next: what befalls the next PUT ('lose_answer', a status, or undefined).
export async function serveTrips(folder, { token = null } = {}) {
  const trips = new Map();
  const asked = [];
  const mood = { next: undefined };
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, 'http://x');
    asked.push(`${request.method} ${pathname}`);
    const [, sha256] = /^\/v1\/trips\/([0-9a-f]{64})$/.exec(pathname) ?? [];
    const send = (status, body, headers = {}) =>
      response.writeHead(status, { 'Content-Type': 'application/json', ...headers }).end(body && JSON.stringify(body));
    if (!sha256) {
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
      if (token && request.headers.authorization !== `Bearer ${token}`) {
        send(401, { title: 'token needed' }, { 'WWW-Authenticate': 'Bearer' });
      } else if (request.method === 'GET') {
        send(trips.has(sha256) ? 200 : 404, { sha256 });
      } else if (request.method === 'DELETE') {
        send(trips.delete(sha256) ? 204 : 404);
      } else if (typeof mood.next === 'number') {
        const status = mood.next;
        mood.next = undefined;
        send(status, { title: 'not now' }, { 'Retry-After': '1' });
      } else {
        const body = Buffer.concat(chunks);
        if (createHash('sha256').update(body).digest('hex') !== sha256) {
          send(422, { detail: 'the hash differs' });
          return;
        }
        const status = trips.has(sha256) ? 200 : 202;
        trips.set(sha256, body);
        if (mood.next === 'lose_answer') {
          mood.next = undefined;
          send(502, { title: 'bad gateway' }, { 'Retry-After': '1' }); // as a proxy says that lost it
          return;
        }
        send(status, { sha256 }, { Location: `/v1/trips/${sha256}` });
      }
    });
  });
  await new Promise((ready) => { server.listen(0, '127.0.0.1', ready); });
  return {
    url: `http://127.0.0.1:${server.address().port}/drive/`, trips, asked, mood,
    close: () => { server.closeAllConnections(); server.close(); },
  };
}
