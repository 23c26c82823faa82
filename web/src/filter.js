// The reader's filter, as a question to segments, to rows of the totals, and as an expression of the map.
import { hidden, state } from './state.js';

export const passSteps = [1, 2, 5, 10];
export const confidenceLimits = [0.15, 0.3]; // half a 90 % interval, relative to the IRI

// 0 = narrow, 1, 2 = wide, as in the totals.
export function confidenceOf({ iri, iri_low: low, iri_high: high }) {
  const step = confidenceLimits.findIndex((limit) => (high - low) / 2 <= limit * iri);
  return step < 0 ? 2 : step;
}

export const noKind = '-'; // of roads without a class in the map
export const isFiltered = () => state.c !== '' || state.h !== '' || state.p > 1 || state.q < 2;

export function shows(segment) {
  return !hidden('c').has(segment.class) && !hidden('h').has(segment.highway ?? noKind) && segment.passes >= (state.p > 1 ? state.p : 0) &&
    (state.q === 2 || confidenceOf(segment) <= state.q);
}

// Kilometres of the rows of the totals that pass, by what `key` makes of a row. `except` leaves out one condition, so that a legend tells what
// it would add.
export function kilometres({ rows }, site, key, except) {
  const sums = new Map();
  const classes = hidden('c');
  const highways = hidden('h');
  const step = passSteps.findLastIndex((passes) => passes <= state.p);
  for (const row of rows) {
    const [inClass, highway, passes, confidence, bin, km] = row;
    if (except !== 'c' && classes.has(site.classes[inClass].name)) continue;
    if (except !== 'h' && highways.has(site.highways[highway] || noKind)) continue;
    if (except !== 'p' && passes < step) continue;
    if (except !== 'q' && confidence > state.q) continue;
    const name = key({ inClass, highway, passes, confidence, bin });
    sums.set(name, (sums.get(name) ?? 0) + km);
  }
  return sums;
}

const half = ['/', ['-', ['get', 'iri_high'], ['get', 'iri_low']], 2];
export const isWide = (limit) => ['case', ['has', 'iri_high'], ['>', half, ['*', limit, ['get', 'iri']]], false];

export function mapFilter() {
  const all = ['all'];
  if (state.c) all.push(['!', ['in', ['get', 'class'], ['literal', [...hidden('c')]]]]);
  if (state.h) all.push(['!', ['in', ['coalesce', ['get', 'highway'], noKind], ['literal', [...hidden('h')]]]]);
  if (state.p > 1) all.push(['>=', ['get', 'passes'], state.p]);
  if (state.q < 2) all.push(['!', isWide(confidenceLimits[state.q])]);
  return all;
}
