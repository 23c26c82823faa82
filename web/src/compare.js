// Two months compared: what is shown of a segment is the difference, grey where it may be chance.
import { parseId } from './data.js';
import { seenBox } from './gliding.js';
import { state } from './state.js';

const source = { source: 'roads', sourceLayer: 'roughness' };
const z90 = 1.645; // 90 %, two-sided
const shown = new WeakMap(); // of a map, what it compares

// Has a map compared again, as after the loss of its feature states.
export const forgetCompared = (map) => shown.delete(map);

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

// Tiles that may have segments in a box of a map's picture, as 'column/row'.
function tilesIn(map, { left, top, right, bottom }, { bounds: [west, south, east, north], compare: { zoom } }) {
  const [northWest, southEast] = [map.unproject([left, top]), map.unproject([right, bottom])];
  const side = 2 ** zoom;
  const column = (lon) => Math.floor((lon + 180) / 360 * side);
  const row = (lat) => Math.floor((1 - Math.asinh(Math.tan(lat * Math.PI / 180)) / Math.PI) / 2 * side);
  const found = [];
  for (let x = column(Math.max(northWest.lng, west)); x <= column(Math.min(southEast.lng, east)); ++x) {
    for (let y = row(Math.min(northWest.lat, north)); y <= row(Math.max(southEast.lat, south)); ++y) found.push(`${x}/${y}`);
  }
  return found;
}

// Sets the differences of the segments in the map's picture, also of its margin that is not seen, and tells how many are in view.
export async function compareMonths(map, { site, months }, tell) {
  const [before, after] = [state.a, state.b].map((month) => site.months.indexOf(month));
  if (before < 0 || after < 0 || map.getZoom() < site.compare.zoom) {
    tell(null);
    return;
  }
  const { clientWidth, clientHeight } = map.getContainer();
  const seen = tilesIn(map, seenBox(map), site);
  const drawn = tilesIn(map, { left: 0, top: 0, right: clientWidth, bottom: clientHeight }, site);
  const asked = [...new Set([...seen, ...drawn])].slice(0, 64); // what is seen comes first
  const key = `${before} ${after} ${seen.length} ${asked.join(' ')}`;
  if (key === shown.get(map)) return;
  shown.set(map, key);
  let found;
  try {
    found = await Promise.all(asked.map((tile) => months(...tile.split('/'))));
  } catch (failure) {
    if (shown.get(map) !== key) return;
    forgetCompared(map);
    throw failure;
  }
  if (shown.get(map) !== key) return;
  map.removeFeatureState(source);
  const counts = { better: 0, worse: 0, unsure: 0 };
  found.forEach((tile, i) => {
    for (const [id, each] of Object.entries(tile)) {
      const told = difference(each, before, after);
      if (!told) continue;
      map.setFeatureState({ ...source, id: featureId(id) }, told);
      if (i < seen.length) counts[told.sure ? (told.change < 0 ? 'better' : 'worse') : 'unsure'] += 1;
    }
  });
  tell(counts);
}
