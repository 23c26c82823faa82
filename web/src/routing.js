// The route of the reader: its points, in the address, and what map and drawer show of it.
import { addFeatures, newNetwork, opposite, routeAlong } from './network.js';
import { parseId } from './data.js';
import { routeDetail } from './profile.js';
import { choose, link, state } from './state.js';
import { roadName, w } from './words.js';

const mostSegments = 2000; // of a route in an address: 40 km
const points = () => (state.r ? state.r.split(',') : []);
// Segments as the parts of ways in the address, 'FIRST~LAST,…', so that a link needs no tiles to find them again.
const rangesOf = (route) => {
  const ranges = [];
  let before = null;
  for (const each of route) {
    if (before && before.way === each.way && before.backward === each.backward && Math.abs(before.index - each.index) === 1) ranges.at(-1)[1] = each.segment;
    else ranges.push([each.segment, each.segment]);
    before = each;
  }
  return ranges.map((ends) => ends.join('~')).join(',');
};
function idsOf(ranges) {
  const ids = [];
  for (const range of ranges.split(',')) {
    const [first, last] = range.split('~').map(parseId);
    if (!first || !last || first.way !== last.way || first.backward !== last.backward) continue;
    const step = Math.sign(last.index - first.index) || 1;
    for (let index = first.index; ids.length < mostSegments && index !== last.index + step; index += step) ids.push(`${first.way}${first.backward ? '-' : '+'}${String(index).padStart(4, '0')}`);
  }
  return ids;
}
const middle = (line) => line[Math.floor(line.length / 2)];

// `act`: show(content, focus) and close() the drawer, openSegment(id), copy(text, button), told(isOn).
export function openRouting(data, map, act) {
  let network = newNetwork();
  const known = new Map(); // segments of points, by id
  let isOn = false;
  let isFull = false;
  let route = null;
  let afar = null; // a place clicked where segments are not drawn

  const find = (id) => network.segments.get(id) ?? network.segments.get(opposite(id)) ?? known.get(id);
  function learn(segments) {
    segments.forEach((each) => known.set(each.segment, each));
    addFeatures(network, segments.map(({ line, months, ...properties }) => ({ properties, geometry: { type: 'LineString', coordinates: line } })));
  }
  const gather = () => { isFull = !addFeatures(network, map.segments()) || isFull; };

  function reason(ids) {
    if (afar) return w('site.route_zoom');
    if (ids.length < 2) return w('site.route_points');
    if (route) return '';
    return w(isFull ? 'site.route_full' : 'site.route_none');
  }

  function draw(focus = false) {
    const ids = points();
    route = ids.length > 1 ? routeAlong(network, ids) : null;
    choose({ way: route ? rangesOf(route) : '' });
    const places = ids.map((id, i) => (route && i === 0 ? route[0].line[0] : route && i === ids.length - 1 ? route.at(-1).line.at(-1) : find(id) && middle(find(id).line)));
    map.markEnds(places.filter(Boolean), moved);
    if (!route) map.markPicked(ids.map(find).filter(Boolean).map(({ line }) => line));
    act.show(routeDetail({ names: ids.map((id) => (find(id) ? roadName(find(id)) : id)), route, why: reason(ids) }, data.site, {
      show: (lines) => map.markPicked(lines),
      open: (id) => act.openSegment(id),
      copy: (button) => act.copy(link(), button),
      remove: (i) => set(points().filter((_, each) => each !== i)),
      reverse: () => set(points().reverse()),
      end,
    }), focus);
  }

  function set(ids) {
    afar = null;
    choose({ r: ids.join(','), s: '' });
    draw();
  }

  function begin() {
    isOn = true;
    if (isFull) network = newNetwork();
    isFull = false;
    gather();
    act.told(true);
  }

  function end() {
    isOn = false;
    route = null;
    afar = null;
    choose({ r: '', way: '' });
    map.markEnds([], moved);
    act.told(false);
    act.close();
  }

  function moved(i, found) {
    const to = found.find(({ segment }) => segment);
    gather();
    set(points().map((id, each) => (each === i && to ? to.segment : id)));
  }

  return {
    isOn: () => isOn,
    toggle() {
      if (isOn) return end();
      begin();
      return draw(true);
    },
    // A road that was opened becomes the next point.
    add(segment) {
      learn([segment]);
      if (!isOn) begin();
      set([...points(), segment.segment]);
    },
    // The map was clicked.
    picked(found, at) {
      const to = found.find(({ segment }) => segment);
      gather();
      if (to) set([...points(), to.segment]);
      else if (found.length > 0) {
        afar = at;
        draw();
        map.zoomIn(at);
      }
    },
    // More tiles are there: a way that was missing may be among them.
    idle() {
      if (!isOn) return;
      const before = network.segments.size;
      gather();
      const isNews = network.segments.size > before && points().length > 1 && !route;
      if (isNews || (afar && before !== network.segments.size)) {
        afar = null;
        draw();
      }
    },
    draw,
    end,
    // From the address.
    async restore() {
      const ids = points();
      if (ids.length === 0) return;
      const segments = (await Promise.all([...ids, ...idsOf(state.way)].map((id) => data.segment(id)))).filter(Boolean);
      learn(segments);
      const toFit = !state.map;
      begin();
      draw();
      const places = segments.flatMap(({ line }) => line);
      const [lon, lat] = [0, 1].map((axis) => places.map((place) => place[axis]));
      if (toFit && places.length > 0) map.fit([Math.min(...lon), Math.min(...lat), Math.max(...lon), Math.max(...lat)], 16);
    },
  };
}
