// Two months compared: what is shown of a segment is the difference, grey where it may be chance.
import { parseId } from './data.js';
import { seenBox } from './gliding.js';
import { state } from './state.js';

const source = { source: 'roads', sourceLayer: 'roughness' };
const z90 = 1.645; // 90 %, two-sided
const shown = new WeakMap(); // of a map, what it compares

// The number of a segment's feature (docs/reference/vector-tiles.md).
function featureId(id) {
  const { way, backward, index } = parseId(id);
  return way * 2 ** 19 + index * 2 + (backward ? 1 : 0);
}

export function changeColour(css) {
  return ['case', ['==', ['feature-state', 'change'], null], css('--unknown'), ['==', ['feature-state', 'sure'], false], css('--unsure'),
    ['interpolate', ['linear'], ['feature-state', 'change'], -1.5, '#2166ac', -0.1, '#92c5de', 0.1, '#f4a582', 1.5, '#b2182b']];
}

// The class of one of the months where they differ by more than chance.
export function monthColour(css, classes, month) {
  const steps = classes.flatMap(({ colour, below }) => (below === null ? [colour] : [colour, below]));
  return ['case', ['==', ['feature-state', 'change'], null], css('--unknown'), ['==', ['feature-state', 'sure'], false], css('--unsure'), ['step', ['feature-state', month], ...steps]];
}

// Months of a segment as [month, iri, sd] to the difference of two of them.
export function difference(months, before, after) {
  const [a, b] = [before, after].map((sought) => months.find(([month]) => month === sought));
  if (!a || !b) return null;
  const change = b[1] - a[1];
  return { before: a[1], after: b[1], change, sure: Math.abs(change) > z90 * Math.hypot(a[2], b[2]) };
}

export async function compareMonths(map, { site, months }, tell) {
  const [before, after] = [state.a, state.b].map((month) => site.months.indexOf(month));
  if (before < 0 || after < 0 || map.getZoom() < site.compare.zoom) {
    tell(null);
    return;
  }
  const { left, top, right, bottom } = seenBox(map);
  const [northWest, southEast] = [map.unproject([left, top]), map.unproject([right, bottom])];
  const tiles = 2 ** site.compare.zoom;
  const column = (lon) => Math.floor((lon + 180) / 360 * tiles);
  const row = (lat) => Math.floor((1 - Math.asinh(Math.tan(lat * Math.PI / 180)) / Math.PI) / 2 * tiles);
  const asked = [];
  for (let x = column(northWest.lng); x <= column(southEast.lng) && asked.length < 64; ++x) {
    for (let y = row(northWest.lat); y <= row(southEast.lat) && asked.length < 64; ++y) asked.push([x, y]);
  }
  const key = `${before} ${after} ${asked.join(' ')}`;
  if (key === shown.get(map)) return;
  shown.set(map, key);
  const found = await Promise.all(asked.map(([x, y]) => months(x, y)));
  if (shown.get(map) !== key) return;
  map.removeFeatureState(source);
  const counts = { better: 0, worse: 0, unsure: 0 };
  for (const [id, each] of found.flatMap((tile) => Object.entries(tile))) {
    const told = difference(each, before, after);
    if (!told) continue;
    map.setFeatureState({ ...source, id: featureId(id) }, told);
    counts[told.sure ? (told.change < 0 ? 'better' : 'worse') : 'unsure'] += 1;
  }
  tell(counts);
}
