// What the page asks for (docs/reference/site.md), relative to site.json; the same from a folder of files and from a server.
export class Failed extends Error {
  constructor(url, status) {
    super(`${url}: ${status}`);
    this.url = url;
    this.status = status;
  }
}

const cache = new Map();
const busy = new Set();
export const onBusy = (tell) => busy.add(tell);
let open = 0;
const tell = (change) => { open += change; busy.forEach((each) => each(open > 0)); };

async function ask(url, missing) {
  tell(1);
  try {
    let response;
    try {
      response = await fetch(url);
    } catch {
      throw new Failed(url, navigator.onLine ? 'network' : 'offline');
    }
    if (response.status === 204 || (response.status === 404 && missing !== undefined)) return missing === undefined ? {} : missing;
    if (!response.ok) throw new Failed(url, response.status);
    return await response.json();
  } finally {
    tell(-1);
  }
}

// An answer is kept, a failure is not.
function once(url, missing) {
  if (!cache.has(url)) {
    cache.set(url, ask(url, missing).catch((failure) => { cache.delete(url); throw failure; }));
    if (cache.size > 400) cache.delete(cache.keys().next().value);
  }
  return cache.get(url);
}

export function parseId(id) {
  const match = /^(-?\d+)([+-])(\d+)$/.exec(id ?? '');
  return match && { way: Number(match[1]), backward: match[2] === '-', index: Number(match[3]) };
}
const order = (a, b) => a.way - b.way || a.backward - b.backward || a.index - b.index;

// The number of the last file whose first key does not come after the key sought; -1 if all do.
function shardOf(index, isAfter) {
  let low = -1;
  let high = index.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (isAfter(index[middle])) high = middle; else low = middle;
  }
  return low;
}

export const folded = (text) => text.toLowerCase().replace(/ß/g, 'ss').replace(/ς/g, 'σ').trim();

export async function openSite() {
  const site = await once('site.json');

  // Reads by the addresses of `site`; where a server has a newer version by now, by its addresses.
  async function latest(read) {
    try {
      return await read();
    } catch (failure) {
      if (failure.status !== 410) throw failure;
      cache.clear();
      Object.assign(site, await once('site.json'));
      return read();
    }
  }

  return {
    site,
    words: (language) => once(`words/${language}.json`),
    worst: () => once(site.worst),
    totals: () => once(site.totals),

    segment: (id) => latest(async () => {
      const key = parseId(id);
      if (!key) return null;
      const { index, url } = site.segments;
      if (!index) return once(url.replace('{id}', encodeURIComponent(id)), null);
      const shard = shardOf(await once(index), (first) => order(parseId(first), key) > 0);
      return shard < 0 ? null : (await once(url.replace('{shard}', shard)))[id] ?? null;
    }),

    // All segments in the order of their keys, file by file; where a server has a newer version by now, the rest is from its files.
    async* segments() {
      let version, shard, last;
      const follows = (id) => !last || order(parseId(id), last) > 0;
      const next = () => latest(async () => {
        const { index, url } = site.segments;
        const firsts = await once(index);
        if (version !== index) {
          version = index;
          shard = Math.max(0, shardOf(firsts, follows));
        }
        return shard < firsts.length ? Object.entries(await ask(url.replace('{shard}', shard))) : null;
      });
      for (let rows = await next(); rows; rows = await next()) {
        ++shard;
        const fresh = rows.filter(([id]) => follows(id));
        if (fresh.length === 0) continue;
        last = parseId(fresh.at(-1)[0]);
        yield fresh.map(([, segment]) => segment);
      }
    },

    names: (start, most = 12) => latest(async () => {
      const begin = folded(start);
      const { index, url } = site.names;
      if (!index) return (await once(url.replace('{text}', encodeURIComponent(begin)))).slice(0, most);
      const firsts = await once(index);
      const found = [];
      for (let shard = Math.max(0, shardOf(firsts, (first) => first >= begin)); shard < firsts.length && found.length < most; ++shard) {
        const names = await once(url.replace('{shard}', shard));
        found.push(...names.filter(({ key }) => key.startsWith(begin)));
        if (names.length > 0 && names.at(-1).key > begin && !names.at(-1).key.startsWith(begin)) break;
      }
      return found.slice(0, most);
    }),

    months: (x, y) => latest(() => once(site.compare.url.replace('{z}', site.compare.zoom).replace('{x}', x).replace('{y}', y), {})),
  };
}
