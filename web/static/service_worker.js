// Keeps the page and what of it was seen, so that both open without a network. While there is one everything is asked anew: nothing old is
// shown. What is kept is of one version of the data, that of site.json and of the archive of tiles; another one clears it.
const scope = new URL('./', location).pathname;
const kept = { page: `macadam-site page ${scope}`, data: `macadam-site data ${scope}` };
const page = ['./', 'assets/site.js', 'assets/site.css', 'assets/icon.svg', 'assets/pmtiles.js', 'assets/maplibre-gl.mjs', 'assets/maplibre-gl-worker.mjs', 'assets/maplibre-gl.css'];
const start = ['site.json', 'totals.json', 'worst.json', 'words/en.json', 'words/de.json'];
const mostAnswers = 300; // of data: tiles and lists, most of them below 200 kB
const isPage = /^(index\.html)?$|^assets\//;
const isData = /^(site|totals|worst|names)\.json$|^(words|segments|names|months)\/.*\.json$|^(map\/)?tiles\/|\.pmtiles$|^overview\.png$/;

const stamp = ({ headers }) => headers.get('ETag') ?? headers.get('Last-Modified') ?? '';

addEventListener('install', (event) => {
  event.waitUntil((async () => {
    await (await caches.open(kept.page)).addAll(page);
    await (await caches.open(kept.data)).addAll(start);
    await skipWaiting();
  })());
});

addEventListener('activate', (event) => event.waitUntil(clients.claim()));

// A part of a file is kept as a whole answer under a name of its own.
function keyOf(request, path) {
  const range = request.headers.get('Range');
  const url = new URL(path, registration.scope);
  if (range) url.searchParams.set('part', range);
  else url.search = new URL(request.url).search;
  return url.href;
}

async function keep(request, path, response) {
  const name = isPage.test(path) ? kept.page : kept.data;
  const isPart = response.status === 206;
  if (!(response.ok && (response.status === 200 || isPart)) || response.redirected) return;
  const cache = await caches.open(name);
  const before = path === 'site.json' || path.endsWith('.pmtiles') ? (await cache.match(new URL(`${path}?stamp`, registration.scope).href)) : undefined;
  const body = await response.arrayBuffer();
  if (path === 'site.json' || path.endsWith('.pmtiles')) {
    const now = path === 'site.json' ? new TextDecoder().decode(body) : stamp(response);
    if (before && (await before.text()) !== now) await Promise.all((await cache.keys()).map((key) => cache.delete(key)));
    await cache.put(new URL(`${path}?stamp`, registration.scope).href, new Response(now));
  }
  const headers = new Headers({ 'Content-Type': response.headers.get('Content-Type') ?? '', ETag: response.headers.get('ETag') ?? '' });
  if (isPart) headers.set('X-Part', response.headers.get('Content-Range') ?? '');
  const key = keyOf(request, path);
  await cache.delete(key); // to be the latest
  await cache.put(key, new Response(body, { headers }));
  if (name === kept.data) {
    const keys = await cache.keys();
    const isStart = (url) => start.some((each) => url.includes(`/${each}`)) || url.endsWith('?stamp');
    await Promise.all(keys.slice(0, Math.max(0, keys.length - mostAnswers)).filter(({ url }) => !isStart(url)).map((old) => cache.delete(old)));
  }
}

async function keptAnswer(request, path) {
  const look = async () => (await caches.open(isPage.test(path) ? kept.page : kept.data)).match(keyOf(request, path === 'index.html' ? '' : path));
  const found = (await look()) ?? (await keeping.then(look)); // it may be on its way into the cache
  const part = found?.headers.get('X-Part');
  return part ? new Response(await found.arrayBuffer(), { status: 206, headers: { 'Content-Range': part, ETag: found.headers.get('ETag') } }) : found ?? Response.error();
}

let keeping = Promise.resolve(); // one answer after the other

addEventListener('fetch', (event) => {
  const { request } = event;
  const url = new URL(request.url);
  if (request.method !== 'GET' || url.origin !== location.origin || !url.pathname.startsWith(scope)) return;
  const path = decodeURIComponent(url.pathname.slice(scope.length));
  if (!isPage.test(path) && !isData.test(path)) return;
  event.respondWith(fetch(request).then((response) => {
    const copy = response.clone();
    keeping = keeping.then(() => keep(request, path, copy)).catch(() => {});
    event.waitUntil(keeping);
    return response;
  }, () => keptAnswer(request, path)));
});
