// The map: measured roads by class, confidence or change, picked by click, touch or keyboard.
import { firstPadding, paddingIn, roomy } from './first_picture.js';
import { backgroundLayers, paintBackground } from './background.js';
import { confidenceLimits, isWide, mapFilter } from './filter.js';
import { el } from './dom.js';
import { glides, letGlide, seenBox } from './gliding.js';
import { choose, state } from './state.js';
import { changeColour, compareMonths, forgetCompared, monthColour } from './compare.js';
import { openSwipe } from './swipe.js';

const layer = 'roughness';
const roadLayers = ['roads', 'roads-wide'];
const segmentsFrom = 14; // zoom
const reach = { mouse: 8, touch: 22 }; // pixels from a click

const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const isSwiped = () => state.mode === 'change' && state.swipe === 'on' && state.a !== '' && state.b !== '';

// `month`: which of the two that are swiped.
function colour(site, month = 'before') {
  if (isSwiped()) return monthColour(css, site.classes, month);
  if (state.mode === 'change') return changeColour(css);
  if (state.mode === 'confidence') {
    return ['case', ['!', ['has', 'iri_high']], css('--mid-confidence'), isWide(confidenceLimits[1]), css('--low-confidence'),
      isWide(confidenceLimits[0]), css('--mid-confidence'), css('--high-confidence')];
  }
  return ['match', ['get', 'class'], ...site.classes.flatMap(({ name, colour: value }) => [name, value]), '#999999'];
}

const width = (factor, more) => ['interpolate', ['exponential', 1.5], ['zoom'], 6, 1 * factor + more, 12, 2.5 * factor + more, 16, 6 * factor + more, 19, 14 * factor + more];
const offset = (side) => ['interpolate', ['linear'], ['zoom'], 11.9, 0, 12, 1.6 * side, 16, 4.5 * side, 19, 10 * side];

function styleOf(site) {
  const base = new URL('.', location.href).href;
  const ground = backgroundLayers(site, css);
  const { pmtiles, url } = site.tiles;
  const side = site.left_hand ? -1 : 1;
  const roads = { type: 'line', source: 'roads', 'source-layer': layer };
  const cap = { 'line-cap': 'butt', 'line-join': 'round' };
  const none = { type: 'FeatureCollection', features: [] };
  const placed = { 'line-offset': offset(side) };
  return {
    version: 8,
    sources: {
      roads: { type: 'vector', ...(pmtiles ? { url: `pmtiles://${base}${pmtiles}` } : { tiles: [base + url], minzoom: site.tiles.min_zoom, maxzoom: site.tiles.max_zoom }),
        attribution: '' },
      picked: { type: 'geojson', data: none },
      pointed: { type: 'geojson', data: none },
    },
    layers: [ // on the ground of the style sheet, which need not be drawn
      ...ground.below,
      { id: 'pointed', type: 'line', source: 'pointed', layout: { ...cap, 'line-cap': 'round', visibility: 'none' }, paint: { ...placed, 'line-color': css('--focus'), 'line-width': width(1, 12), 'line-opacity': 0.55 } },
      { id: 'picked', type: 'line', source: 'picked', layout: { ...cap, 'line-cap': 'round', visibility: 'none' }, paint: { ...placed, 'line-color': css('--focus'), 'line-width': width(1, 9) } },
      { ...roads, id: 'casing', layout: cap, paint: { ...placed, 'line-color': css('--casing'), 'line-width': width(1, 1.6) } },
      { ...roads, id: 'roads', layout: cap, paint: { ...placed, 'line-color': colour(site), 'line-width': width(1, 0) } },
      { ...roads, id: 'roads-wide', layout: cap, paint: { ...placed, 'line-color': colour(site), 'line-width': width(1, 0), 'line-dasharray': [1.2, 0.8] } },
      { ...roads, id: 'names', type: 'symbol', minzoom: 13, layout: { 'symbol-placement': 'line', 'text-field': ['coalesce', ['get', 'name'], ''], 'text-font': ['sans-serif'],
        'text-size': 12, 'symbol-spacing': 350 }, paint: { 'text-color': css('--ink'), 'text-halo-color': css('--ground'), 'text-halo-width': 1.6 } },
      ...ground.above,
    ],
  };
}

// Applies filter and colours to the layers of a style.
function paint(map, site, month) {
  const filter = mapFilter();
  const wide = isWide(confidenceLimits[1]);
  map.setFilter('casing', filter);
  map.setFilter('names', filter);
  map.setFilter('roads', ['all', filter, ['!', wide]]);
  map.setFilter('roads-wide', ['all', filter, wide]);
  for (const id of roadLayers) map.setPaintProperty(id, 'line-color', colour(site, month));
  for (const [id, property, name] of [['casing', 'line-color', '--casing'], ['picked', 'line-color', '--focus'],
    ['pointed', 'line-color', '--focus'], ['names', 'text-color', '--ink'], ['names', 'text-halo-color', '--ground']]) {
    map.setPaintProperty(id, property, css(name));
  }
  paintBackground(map, css);
}

const lineOf = (coordinates) => ({ type: 'Feature', properties: {}, geometry: { type: 'LineString', coordinates } });

// Distance in pixels from a point to the nearest part of a feature.
function distance(map, { geometry }, { x, y }) {
  const lines = geometry.type === 'LineString' ? [geometry.coordinates] : geometry.coordinates;
  let nearest = Infinity;
  for (const line of lines) {
    const points = line.map((each) => map.project(each));
    for (let i = 1; i < points.length; ++i) {
      const [a, b] = [points[i - 1], points[i]];
      const [dx, dy] = [b.x - a.x, b.y - a.y];
      const along = Math.max(0, Math.min(1, ((x - a.x) * dx + (y - a.y) * dy) / (dx * dx + dy * dy || 1)));
      nearest = Math.min(nearest, Math.hypot(a.x + along * dx - x, a.y + along * dy - y));
    }
  }
  return nearest;
}

// One feature of each road and direction under the point, the nearest first; of those within reach if none is exactly there.
function pick(map, point, by) {
  let found = map.queryRenderedFeatures(point, { layers: roadLayers });
  if (found.length === 0) {
    const r = reach[by];
    found = map.queryRenderedFeatures([[point.x - r, point.y - r], [point.x + r, point.y + r]], { layers: roadLayers });
  }
  const nearest = new Map();
  for (const feature of found) {
    const { properties } = feature;
    const road = properties.segment ? `${properties.way_id}${properties.direction}` : `${properties.name}${properties.highway}${properties.iri}`;
    const metres = distance(map, feature, point);
    if (!nearest.has(road) || metres < nearest.get(road).metres) nearest.set(road, { metres, properties });
  }
  return [...nearest.values()].sort((a, b) => a.metres - b.metres).map(({ properties }) => properties);
}

// A map that is seen from straight above has no sky, which the library would draw over all of the picture all the same.
function withoutSky(map) {
  map.on('style.load', () => { map.style.sky.getEvaluated = () => undefined; });
}

// Calls `act` when a map has its style again after the browser took its graphics context: feature states are lost then.
function onRestored(map, act) {
  map.on('webglcontextrestored', () => map.once('style.load', () => {
    forgetCompared(map);
    act();
  }));
}

// The libraries come after the first picture.
export async function openMap(container, data, covered, tell) {
  const [maplibre, { Protocol }] = await Promise.all([import('maplibre-gl'), import('pmtiles')]);
  const { site } = data;
  maplibre.addProtocol('pmtiles', new Protocol().tile);
  const place = el('div', { class: 'picture' });
  container.append(place);
  const [zoom, latitude, longitude] = state.map.split('/').map(Number);
  const map = new maplibre.Map({
    container: place, style: styleOf(site), attributionControl: false, maxPitch: 0, dragRotate: false, pitchWithRotate: false, fadeDuration: 0,
    ...(Number.isFinite(longitude) ? { center: [longitude, latitude], zoom } : { bounds: roomy(site.bounds), fitBoundsOptions: { padding: paddingIn(container, covered(), firstPadding) } }),
  });
  const padding = (most) => {
    const seen = seenBox(map);
    const { left, right, top, bottom } = paddingIn(container, covered(), most);
    return { left: left + seen.left, right: right + seen.left, top: top + seen.top, bottom: bottom + seen.top };
  };
  const isGliding = glides(map);
  withoutSky(map);
  map.touchZoomRotate.disableRotation();
  map.addControl(new maplibre.NavigationControl({ showCompass: false }), 'top-right');
  map.addControl(new maplibre.ScaleControl({ unit: state.unit === 'in/mi' ? 'imperial' : 'metric' }), 'bottom-left');

  let pointer = 'mouse'; // Safari's clicks do not tell
  container.addEventListener('pointerdown', ({ pointerType }) => { pointer = pointerType; }, { capture: true });
  map.on('click', (event) => {
    tell.picked(pick(map, event.point, pointer === 'touch' ? 'touch' : 'mouse'), event.lngLat);
  });
  map.on('mousemove', (event) => {
    if (map.isMoving()) return;
    map.getCanvas().style.cursor = map.queryRenderedFeatures(event.point, { layers: roadLayers.filter((id) => map.getLayer(id)) }).length > 0 ? 'pointer' : '';
  });
  const placeInAddress = () => {
    const { lng, lat } = map.getCenter();
    return `${map.getZoom().toFixed(2)}/${lat.toFixed(5)}/${lng.toFixed(5)}`;
  };
  let lastPlace = placeInAddress();
  map.on('moveend', () => { // or resized
    const before = lastPlace;
    lastPlace = placeInAddress();
    if (lastPlace !== before) choose({ map: lastPlace });
  });
  map.on('error', ({ error }) => tell.failed(error));
  let loaded = false;
  let told;
  map.on('load', () => { loaded = true; show(); });
  map.on('webglcontextlost', () => { loaded = false; });
  onRestored(map, () => { loaded = true; show(); });
  map.on('idle', () => {
    container.dataset.ready = 'yes';
    clearTimeout(told);
    told = setTimeout(tell.idle, 30); // after the picture is on the screen
    if (state.mode === 'change') compare();
  });
  if (isGliding) map.once('idle', () => letGlide(map)); // the first picture needs no margin
  map.on('dataloading', () => { delete container.dataset.ready; });

  const compare = () => compareMonths(map, data, tell.compared).catch((error) => tell.failed(error, compare));
  let swipe = null;
  // The later month on a map of its own, which follows this one.
  function openAfter(side) {
    const later = el('div', { class: 'picture' });
    side.append(later);
    const after = new maplibre.Map({ container: later, style: styleOf(site), attributionControl: false, interactive: false, maxPitch: 0, fadeDuration: 0, center: map.getCenter(), zoom: map.getZoom() });
    withoutSky(after);
    if (isGliding) letGlide(after, map);
    const follow = () => after.jumpTo({ center: map.getCenter(), zoom: map.getZoom() });
    const compareToo = () => compareMonths(after, data, () => {}).catch((error) => tell.failed(error, compareToo));
    map.on('move', follow);
    const paintAll = () => { paint(after, site, 'after'); compareToo(); };
    after.on('load', paintAll);
    onRestored(after, paintAll);
    after.on('moveend', compareToo);
    after.on('error', ({ error }) => tell.failed(error));
    return { paint: () => { if (after.loaded()) paint(after, site, 'after'); }, remove: () => { map.off('move', follow); forgetCompared(after); after.remove(); } };
  }
  function showSwipe() {
    const months = `${state.a} ${state.b}`;
    if (swipe && (!isSwiped() || swipe.months !== months)) {
      swipe.close();
      swipe = null;
    }
    if (isSwiped() && !swipe) swipe = { ...openSwipe(container, { before: state.a, after: state.b }, openAfter), months };
    else swipe?.map.paint();
  }
  function show() {
    if (!loaded) return;
    paint(map, site, 'before');
    delete container.dataset.ready;
    showSwipe();
    if (state.mode === 'change') compare();
  }
  const ends = [];
  const mark = (source) => {
    let lines;
    const set = () => {
      map.getSource(source).setData({ type: 'FeatureCollection', features: lines.map(lineOf) });
      map.setLayoutProperty(source, 'visibility', lines.length > 0 ? 'visible' : 'none'); // a layer costs its masks, also an empty one
    };
    return (wanted) => {
      lines = wanted;
      if (loaded) set(); else map.once('idle', set);
    };
  };

  return {
    show,
    remove: () => { clearTimeout(told); swipe?.close(); forgetCompared(map); map.remove(); },
    focus: () => map.getCanvas().focus(),
    markPicked: mark('picked'),
    markPointed: mark('pointed'),
    zoomIn: (at) => map.easeTo({ center: at, zoom: segmentsFrom + 1.5, animate: !matchMedia('(prefers-reduced-motion: reduce)').matches }),
    fit: (bounds, most = 17) =>
      map.fitBounds(roomy(bounds), { padding: padding(60), maxZoom: most, animate: !matchMedia('(prefers-reduced-motion: reduce)').matches }),
    // Whether a place is in view, and not below the drawer.
    sees(at) {
      const { x, y } = map.project(at);
      const seen = seenBox(map);
      const { right, bottom } = covered();
      return x > seen.left && y > seen.top && x < seen.right - right && y < seen.bottom - bottom;
    },
    // All segments of the tiles in view, also those that a filter hides.
    segments: () => (loaded && map.getZoom() >= segmentsFrom ? map.querySourceFeatures('roads', { sourceLayer: layer }) : []),
    // Ends when the tiles in view are there.
    settled: () => new Promise((resolve) => { map.once('idle', resolve).triggerRepaint(); }),
    // Ends of a route, to be dragged: `points` are places, `moved(i, found)` gets the roads at the new one.
    markEnds(points, moved) {
      ends.splice(0).forEach((each) => each.remove());
      points.forEach((at, i) => {
        const node = el('div', { class: `end ${i === 0 ? 'first' : i === points.length - 1 ? 'last' : ''}`, 'aria-hidden': 'true' }, String(i + 1));
        const marker = new maplibre.Marker({ element: node, draggable: true }).setLngLat(at).addTo(map);
        for (const name of ['aria-label', 'role', 'tabindex']) node.removeAttribute(name); // sliders do the same by keyboard
        marker.on('dragend', () => moved(i, pick(map, map.project(marker.getLngLat()), 'touch')));
        ends.push(marker);
      });
    },
    hasSegments: () => map.getZoom() >= segmentsFrom,
    // Features in view that pass the filter, each once.
    inView() {
      const found = new Map();
      if (!loaded) return [];
      const { left, top, right, bottom } = seenBox(map);
      for (const feature of map.queryRenderedFeatures([[left, top], [right, bottom]], { layers: roadLayers })) {
        const { properties } = feature;
        const { segment, name, highway, iri, iri_worst: worst, length_m: metres } = properties;
        found.set(segment ?? `${name} ${highway} ${iri} ${worst} ${metres}`, properties);
      }
      return [...found.values()];
    },
  };
}
