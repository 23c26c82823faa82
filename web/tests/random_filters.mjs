// Filters drawn at random from the grammar of CQL2 (OGC 21-065r2, annex B), of the properties of road segments.
import fc from 'fast-check';

const spaced = (...parts) => fc.tuple(...parts).map((words) => words.join(' '));
const called = (name, ...args) => fc.tuple(name, ...args).map(([word, ...rest]) => `${word}(${rest.join(', ')})`);
const either = fc.constantFrom;

// (cql2-rs reads no exponents.)
const number = fc.oneof(fc.integer({ min: -6, max: 12 }).map(String), fc.integer({ min: -99, max: 999 }).map((hundredths) => (hundredths / 100).toFixed(2)));
const measure = either('iri', 'iri_low', '"iri_high"', 'passes', 'vehicles', 'from_m');
const words = { class: ['poor', 'fair', 'good'], highway: ['residential', 'primary', 'Straße'], '"direction"': ['forward', 'backward', ''], name: ['Weinzierl', 'B3', 'Hafenstraße'] };
const word = either(...Object.keys(words));
const wordWith = (count, of = word) => of.chain((name) => fc.tuple(fc.constant(name), fc.array(either(...words[name]).map((each) => `'${each}'`), { minLength: 1, maxLength: count })));
const day = fc.tuple(either('2025-04', '2025-05', '2025-07', '2025-08'), either('02', '14', '28')).map((parts) => parts.join('-'));
const date = called(either('DATE', 'date'), day.map((each) => `'${each}'`));
const instant = fc.oneof(date, called(fc.constant('TIMESTAMP'), day.map((each) => `'${each}T06:30:00Z'`)));
const seen = either('first_seen', 'last_seen');
const interval = fc.tuple(day, day).map((days) => `INTERVAL(${days.sort().map((each) => `'${each}'`).join(', ')})`);

const place = fc.tuple(fc.integer({ min: 0, max: 999 }), fc.integer({ min: 0, max: 999 })).map(([x, y]) => [15.58 + x * 4.7e-5, 48.395 + y * 2.3e-5]);
const wkt = (points) => points.map(([x, y]) => `${x.toFixed(6)} ${y.toFixed(6)}`).join(', ');
const box = fc.tuple(place, place).map(([[x1, y1], [x2, y2]]) => [[x1, y1], [x2, y1], [x2, y2], [x1, y2], [x1, y1]]).filter(([[x1, y1], , [x2, y2]]) => x1 !== x2 && y1 !== y2);
const shape = fc.oneof(
  box.map((ring) => `POLYGON((${wkt(ring)}))`),
  fc.array(box, { minLength: 1, maxLength: 1 }).map(([ring]) => `MULTIPOLYGON(((${wkt(ring)})))`),
  fc.uniqueArray(place, { minLength: 2, maxLength: 4, selector: String }).map((points) => `LINESTRING(${wkt(points)})`),
  place.map((point) => `POINT(${wkt([point])})`),
);

const { condition } = fc.letrec((tie) => ({
  sum: fc.oneof(
    { depthSize: 'small', withCrossShrink: true },
    { weight: 3, arbitrary: fc.oneof(measure, number) },
    spaced(tie('sum'), either('+', '-', '*'), tie('sum')),
    spaced(tie('sum'), fc.constant('/'), either('2', '0.4', '10')),
    fc.tuple(tie('sum'), either('+', '-')).chain(([left, sign]) => tie('sum').map((right) => `(${left} ${sign} ${right})`)),
  ),
  predicate: fc.oneof(
    spaced(tie('sum'), either('=', '<>', '<', '>', '<=', '>='), tie('sum')),
    spaced(either('iri', '"iri_high"', 'iri - iri_low'), either('<', '>'), either('1', '2.10', '3.3')),
    spaced(either('passes', 'vehicles'), either('=', '<>', '<', '>', '<=', '>='), either('1', '2', '3')),
    fc.tuple(wordWith(1), either('=', '<>')).map(([[name, [value]], sign]) => `${name} ${sign} ${value}`),
    spaced(word, either('LIKE', 'NOT LIKE', 'like'), either("'%e%'", "'W%'", "'_oor'", "'%straße%'", "'poor'")),
    called(either('CASEI', 'casei'), word).chain((left) => spaced(fc.constant(left), fc.constant('='), called(fc.constant('CASEI'), either("'POOR'", "'Forward'", "'WEINZIERL'")))),
    fc.tuple(measure, either('BETWEEN', 'NOT BETWEEN'), either('0', '1.5', '20'), either('2', '4.25', '100')).map(([value, between, low, high]) => `(${value} ${between} ${low} AND ${high})`), // cql2-rs drops what follows one without brackets
    fc.tuple(measure, either('IN', 'NOT IN'), fc.array(number, { minLength: 1, maxLength: 4 })).map(([value, isIn, list]) => `${value} ${isIn} (${list.join(',')})`),
    fc.tuple(wordWith(3, word.filter((name) => name !== 'name')), either('IN', 'NOT IN')).map( // cql2-rs takes an unknown value for one that is not in the list
      ([[name, list], isIn]) => `${name} ${isIn} (${list.join(', ')})`,
    ),
    spaced(either('iri', 'class', 'first_seen', 'geometry'), either('IS NULL', 'IS NOT NULL', 'is not null')),
    spaced(seen, either('<', '>', '<=', '>=', '<>'), instant),
    called(either('T_AFTER', 'T_BEFORE', 'T_EQUALS', 't_intersects', 'T_DISJOINT'), seen, date),
    called(either('T_AFTER', 'T_BEFORE', 'T_INTERSECTS', 'T_DISJOINT', 'T_DURING'), either('INTERVAL(first_seen, last_seen)'), interval),
    called(either('S_INTERSECTS', 'S_DISJOINT', 'S_WITHIN', 's_crosses', 'S_TOUCHES', 'S_OVERLAPS', 'S_EQUALS'), fc.constant('geometry'), shape),
    called(either('S_INTERSECTS', 'S_CONTAINS'), shape, fc.constant('geometry')),
    either('TRUE', 'false'),
  ),
  condition: fc.oneof(
    { depthSize: 'small', withCrossShrink: true },
    { weight: 3, arbitrary: tie('predicate') },
    spaced(tie('condition'), either('AND', 'OR', 'and', 'Or'), tie('condition')),
    tie('condition').map((each) => `(${each})`),
    spaced(fc.constant('NOT'), tie('predicate')),
    tie('condition').map((each) => `NOT (${each})`),
  ),
}));

export { condition };
