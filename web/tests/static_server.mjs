// A plain static host with range requests, for tests alone.
import { createServer } from 'node:http';
import { createReadStream } from 'node:fs';
import { createGzip } from 'node:zlib';
import { stat } from 'node:fs/promises';
import { extname, join, normalize } from 'node:path';

const types = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.mjs': 'text/javascript', '.css': 'text/css', '.json': 'application/json',
  '.svg': 'image/svg+xml', '.pmtiles': 'application/octet-stream',
};

// Serves a folder on a free port of 127.0.0.1; `asked` collects the paths asked for, `sent` counts the bytes of bodies.
export async function serve(folder, { gzip = false } = {}) {
  const asked = [];
  const sent = { bytes: 0 };
  const server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://x').pathname);
    asked.push(path);
    const file = join(folder, normalize(path.endsWith('/') ? `${path}index.html` : path));
    const info = file.startsWith(folder) && await stat(file).catch(() => null);
    if (!info || !info.isFile()) {
      response.writeHead(404).end();
      return;
    }
    const head = { 'Content-Type': types[extname(file)] ?? 'application/octet-stream', 'Accept-Ranges': 'bytes', ETag: `"${info.size}-${info.mtimeMs}"` };
    const range = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? '');
    const from = range ? Number(range[1]) : 0;
    const to = range && range[2] ? Math.min(Number(range[2]), info.size - 1) : info.size - 1;
    if (range) head['Content-Range'] = `bytes ${from}-${to}/${info.size}`;
    const count = (stream) => stream.on('data', (chunk) => { sent.bytes += chunk.length; });
    if (gzip && !range && request.method === 'GET' && /json|text|svg/.test(`${head['Content-Type']} ${extname(file).replace('.geojson', 'json')}`)) {
      response.writeHead(200, { ...head, 'Content-Encoding': 'gzip' });
      count(createReadStream(file).pipe(createGzip({ level: 6 }))).pipe(response);
      return;
    }
    response.writeHead(range ? 206 : 200, { ...head, 'Content-Length': to - from + 1 });
    if (request.method === 'HEAD' || to < from) response.end();
    else count(createReadStream(file, { start: from, end: to })).pipe(response);
  });
  await new Promise((ready) => { server.listen(0, '127.0.0.1', ready); });
  return { url: `http://127.0.0.1:${server.address().port}/`, asked, sent, close: () => { server.closeAllConnections(); server.close(); } };
}
