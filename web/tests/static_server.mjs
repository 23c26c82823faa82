// A plain static host with range requests, for tests alone.
import { createServer } from 'node:http';
import { createReadStream } from 'node:fs';
import { stat } from 'node:fs/promises';
import { extname, join, normalize } from 'node:path';

const types = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.mjs': 'text/javascript', '.css': 'text/css', '.json': 'application/json',
  '.svg': 'image/svg+xml', '.pmtiles': 'application/octet-stream',
};

// Serves a folder on a free port of 127.0.0.1; `asked` collects the paths asked for.
export async function serve(folder) {
  const asked = [];
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
    response.writeHead(range ? 206 : 200, { ...head, 'Content-Length': to - from + 1 });
    if (request.method === 'HEAD' || to < from) response.end();
    else createReadStream(file, { start: from, end: to }).pipe(response);
  });
  await new Promise((ready) => { server.listen(0, '127.0.0.1', ready); });
  return { url: `http://127.0.0.1:${server.address().port}/`, asked, close: () => { server.closeAllConnections(); server.close(); } };
}
