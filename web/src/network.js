// A network of the segments that tiles have shown, and the shortest way along it. Roads without a value are not in tiles: no way leads over them.
import { parseId } from './data.js';

const mostSegments = 60_000;
const sameNode = 1.5; // metres: twice what the coarsest tile with segments rounds to
const metresPerDegree = 111_320;

export const newNetwork = () => ({ segments: new Map(), cells: new Map(), nodes: [], from: [] });

const metresBetween = ([lon1, lat1], [lon2, lat2]) => Math.hypot((lon2 - lon1) * Math.cos(lat1 * Math.PI / 180), lat2 - lat1) * metresPerDegree;
const lengthOf = (line) => line.reduce((sum, point, i) => (i === 0 ? 0 : sum + metresBetween(line[i - 1], point)), 0);

function metresToLine(point, line) {
  const east = Math.cos(point[1] * Math.PI / 180);
  const [px, py] = [point[0] * east, point[1]];
  let nearest = Infinity;
  for (let i = 1; i < line.length; ++i) {
    const [ax, ay, bx, by] = [line[i - 1][0] * east, line[i - 1][1], line[i][0] * east, line[i][1]];
    const [dx, dy] = [bx - ax, by - ay];
    const along = Math.max(0, Math.min(1, ((px - ax) * dx + (py - ay) * dy) / (dx * dx + dy * dy || 1)));
    nearest = Math.min(nearest, Math.hypot(ax + along * dx - px, ay + along * dy - py));
  }
  return nearest * metresPerDegree;
}

// Two parts of a segment that tiles cut: it begins where the other part does not reach.
function joined(a, b) {
  const first = metresToLine(a[0], b) >= metresToLine(b[0], a) ? a : b;
  const last = metresToLine(a.at(-1), b) >= metresToLine(b.at(-1), a) ? a : b;
  return first === last ? first : [...first, ...last];
}

function nodeAt({ cells, nodes, from }, [lon, lat]) {
  const east = Math.cos(lat * Math.PI / 180);
  const [x, y] = [Math.round(lon * metresPerDegree * east / (2 * sameNode)), Math.round(lat * metresPerDegree / (2 * sameNode))];
  for (let i = -1; i <= 1; ++i) {
    for (let j = -1; j <= 1; ++j) {
      const near = cells.get(`${x + i} ${y + j}`)?.find((node) => metresBetween(nodes[node], [lon, lat]) < sameNode);
      if (near !== undefined) return near;
    }
  }
  const key = `${x} ${y}`;
  cells.set(key, [...(cells.get(key) ?? []), nodes.length]);
  from.push([]);
  return nodes.push([lon, lat]) - 1;
}

// Adds segments of tiles: { properties, geometry }. Returns false where no more fit.
export function addFeatures(network, features) {
  const parts = new Map();
  for (const { properties, geometry } of features) {
    if (!properties.segment || network.segments.has(properties.segment)) continue;
    const lines = geometry.type === 'LineString' ? [geometry.coordinates] : geometry.coordinates;
    for (const line of lines) {
      const before = parts.get(properties.segment);
      if (!before) parts.set(properties.segment, { properties, line });
      else before.line = joined(before.line, line);
    }
  }
  for (const [id, { properties, line }] of parts) {
    const metres = properties.to_m - properties.from_m;
    if (lengthOf(line) < metres - 2 * sameNode) continue; // its other part is in a tile to come
    if (network.segments.size >= mostSegments) return false;
    const segment = { ...properties, metres, line, start: nodeAt(network, line[0]), end: nodeAt(network, line.at(-1)), ...parseId(id) };
    network.segments.set(id, segment);
    network.from[segment.start].push(segment);
  }
  return true;
}

// The segment on the other side of the road.
export const opposite = (id) => id.replace(/[+-](?=\d+$)/, (sign) => (sign === '+' ? '-' : '+'));

// Cosine of the turn from the end of one line to the start of the next.
function turn(line, next) {
  const east = Math.cos(next[0][1] * Math.PI / 180);
  const [a, b] = [line.slice(-2), next.slice(0, 2)].map(([[lon1, lat1], [lon2, lat2]]) => [(lon2 - lon1) * east, lat2 - lat1]);
  return (a[0] * b[0] + a[1] * b[1]) / (Math.hypot(...a) * Math.hypot(...b) || 1);
}
const sharpestTurn = -0.5; // 120 degrees: beyond it a road turns round

// The segment of the same road after one (`step` 1) or before it (-1), also of another OSM way; null unless exactly one continues it.
export function continuation(network, { segment: id }, step) {
  const at = network.segments.get(id);
  if (!at) return null;
  const isSameRoad = ({ name, highway }) => (name || at.name ? name === at.name : (highway ?? null) === (at.highway ?? null));
  const others = step > 0 ? network.from[at.end] : [...network.segments.values()].filter(({ end }) => end === at.start);
  const found = others.filter((each) => isSameRoad(each) && (step > 0 ? turn(at.line, each.line) : turn(each.line, at.line)) > sharpestTurn);
  return found.length === 1 ? found[0].segment : null;
}

const push = (heap, item) => {
  let at = heap.push(item) - 1;
  for (let up = (at - 1) >> 1; at > 0 && heap[up].cost > item.cost; at = up, up = (at - 1) >> 1) heap[at] = heap[up];
  heap[at] = item;
};
const pop = (heap) => {
  const top = heap[0];
  const item = heap.pop();
  if (heap.length === 0) return top;
  let at = 0;
  for (;;) {
    let down = 2 * at + 1;
    if (down >= heap.length) break;
    if (down + 1 < heap.length && heap[down + 1].cost < heap[down].cost) ++down;
    if (heap[down].cost >= item.cost) break;
    heap[at] = heap[down];
    at = down;
  }
  heap[at] = item;
  return top;
};

// Segments of the shortest way, without turning round, from one of some segments to one of others; null if there is none.
function shortest(network, starts, goals) {
  const cost = new Map();
  const before = new Map();
  const open = [];
  const reach = (segment, metres, from) => {
    if (metres >= (cost.get(segment) ?? Infinity)) return;
    cost.set(segment, metres);
    before.set(segment, from);
    push(open, { cost: metres, segment });
  };
  starts.forEach((segment) => reach(segment, segment.metres, null));
  while (open.length > 0) {
    const { cost: metres, segment } = pop(open);
    if (metres > cost.get(segment)) continue;
    if (goals.includes(segment)) {
      const way = [];
      for (let each = segment; each; each = before.get(each)) way.push(each);
      return way.reverse();
    }
    for (const next of network.from[segment.end]) {
      const turnsRound = next.way === segment.way && next.backward !== segment.backward && next.index === segment.index;
      if (!turnsRound) reach(next, metres + next.metres, segment);
    }
  }
  return null;
}

// Segments along some points, each a segment in either direction of the road; null if a part has no way.
export function routeAlong(network, ids) {
  const sides = (id) => [id, opposite(id)].map((each) => network.segments.get(each)).filter(Boolean);
  let route = null;
  for (let i = 1; i < ids.length; ++i) {
    const leg = shortest(network, route ? [route.at(-1)] : sides(ids[i - 1]), sides(ids[i]));
    if (!leg) return null;
    route = route ? [...route, ...leg.slice(1)] : leg;
  }
  return route;
}
