// Requests drawn at random from an OpenAPI definition: fitting values, hostile ones and any text.
import fc from 'fast-check';
import { createHash } from 'node:crypto';

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

const filled = (pattern, inPath, words) => inPath.reduce((text, { name }, i) => text.replace(`{${name}}`, encodeURIComponent(words[i])), pattern);

// Requests to read a path that is open to all.
function reading(pattern, operation) {
  const parameters = operation.parameters ?? [];
  const inPath = parameters.filter((parameter) => parameter.in === 'path');
  const query = parameters.filter((parameter) => parameter.in === 'query');
  return fc.tuple(
    fc.tuple(...inPath.map(valueOf)),
    query.length ? fc.subarray(query, { maxLength: Math.min(4, query.length) }).chain((chosen) => fc.tuple(...chosen.map((parameter) => valueOf(parameter).map((value) => [parameter.name, value])))) : fc.constant([]),
    fc.oneof({ weight: 9, arbitrary: fc.constant('GET') }, { weight: 1, arbitrary: fc.constant('HEAD') }),
  ).map(([words, pairs, method]) => {
    const text = new URLSearchParams(pairs.map(([name, value]) => [name, String(value)])).toString();
    const path = filled(pattern, inPath, words);
    return { pattern, operation, method, target: text ? `${path}?${text}` : path, headers: {} };
  });
}

const hashOf = (text) => createHash('sha256').update(text).digest('hex');

// Few logs, so that those that were sent are asked for, sent again and deleted.
const log = fc.oneof({ weight: 4, arbitrary: fc.integer({ min: 1, max: 12 }).map((number) => `a log, number ${number}`) }, { weight: 1, arbitrary: fc.string() });
const type = fc.oneof({ weight: 6, arbitrary: fc.constantFrom('text/csv', 'application/gzip', 'application/zip') }, { weight: 1, arbitrary: fc.constantFrom('image/png', '', 'text/csv; charset=utf-16', '*/*') });
const named = fc.constantFrom(undefined, undefined, undefined, 'attachment; filename="a.trip.csv.zst"', 'attachment; filename="../../../etc/cron.d/x.csv"', 'attachment; filename*=UTF-8\'\'%2e%2e%2fx.csv');
const secret = (tokens) => fc.oneof({ weight: 8, arbitrary: fc.constantFrom('anna', 'anna', 'ben', ...Object.keys(tokens)) }, { weight: 3, arbitrary: fc.constantFrom('none', 'forged', 'cut', 'spoilt') });

function authorization(tokens, who, basic) {
  const text = tokens[who] ?? { none: undefined, forged: `mac_00000000_${'0'.repeat(64)}`, cut: tokens.anna.slice(0, -1), spoilt: "mac_' OR 1=1--" }[who];
  return text === undefined ? {} : { Authorization: basic ? `Basic ${Buffer.from(`any:${text}`).toString('base64')}` : `Bearer ${text}` };
}

// Requests to read a path for holders of tokens, with their tokens and those of others.
const readingWithToken = (pattern, operation, tokens) => fc.tuple(reading(pattern, operation), secret(tokens), fc.boolean()).map(([drawn, who, basic]) => ({ ...drawn, headers: authorization(tokens, who, basic) }));

// Requests about a log, with right bytes and others.
function aboutLog(pattern, method, operation, tokens) {
  const inPath = (operation.parameters ?? []).filter((parameter) => parameter.in === 'path');
  return fc.record({ sent: log, hashed: log, bytes: fc.constantFrom('right', 'right', 'right', 'right', 'forged', 'none'), word: fc.constantFrom(...hostile.filter(Boolean)), who: secret(tokens), basic: fc.boolean(), type, named }).map((drawn) => {
    const hash = { right: hashOf(drawn.sent), forged: hashOf(drawn.hashed), none: drawn.word }[drawn.bytes];
    const target = filled(pattern, inPath, inPath.map(({ name }) => (name === 'sha256' ? hash : drawn.word)));
    const headers = { ...authorization(tokens, drawn.who, drawn.basic), ...(drawn.type ? { 'Content-Type': drawn.type } : {}), ...(drawn.named ? { 'Content-Disposition': drawn.named } : {}) };
    return { pattern, operation, method: method.toUpperCase(), target, headers, body: method === 'put' ? drawn.sent : undefined };
  });
}

// Requests of a server, mostly to read features and to send trips.
export function requests(api, tokens) {
  const weighted = [];
  for (const [pattern, operations] of Object.entries(api.paths)) {
    for (const [method, operation] of Object.entries(operations)) {
      const isOfLog = pattern.startsWith('/v1/') && pattern !== '/v1/trips';
      weighted.push({
        weight: pattern === '/collections/{collectionId}/items' ? 15 : pattern === '/v1/trips/{sha256}' ? 6 : 1,
        arbitrary: isOfLog ? aboutLog(pattern, method, operation, tokens) : operation.security ? readingWithToken(pattern, operation, tokens) : reading(pattern, operation),
      });
    }
  }
  // Paths of a database on a server, or of none: without an operation.
  weighted.push({ weight: 1, arbitrary: fc.tuple(fc.constantFrom('/queue', '/queue/', '/queue/status', '/v1', '/v1/', '/v1/tokens/x'), secret(tokens)).map(([target, who]) => ({ pattern: target, method: 'GET', target, headers: authorization(tokens, who, true) })) });
  return fc.oneof(...weighted);
}
