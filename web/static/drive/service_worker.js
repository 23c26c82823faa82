// Keeps the page, so that it opens without a network. A visit shows what is kept and fetches the newest beside it.
const kept = 'macadam-drive';
const page = ['./', 'drive.js', 'drive.css', 'manifest.webmanifest', 'icon.svg', 'icon-180.png', 'icon-512.png'];

addEventListener('install', (event) => {
  event.waitUntil(caches.open(kept).then((cache) => cache.addAll(page)).then(() => skipWaiting()));
});

addEventListener('activate', (event) => event.waitUntil(clients.claim()));

addEventListener('fetch', (event) => {
  const { request } = event;
  const url = new URL(request.url);
  const isOurs = url.origin === location.origin && url.pathname.startsWith(new URL('./', location).pathname);
  if (request.method !== 'GET' || !isOurs) {
    return;
  }
  const answer = async () => {
    const cache = await caches.open(kept);
    const before = await cache.match(request, { ignoreSearch: true });
    const newest = fetch(request).then(async (response) => {
      if (response.ok && !response.redirected) {
        await cache.put(new Request(url.pathname), response.clone());
      }
      return response;
    });
    if (!before) {
      return newest;
    }
    event.waitUntil(newest.catch(() => {}));
    return before;
  };
  event.respondWith(answer());
});
