// What lies below the roads: water, green, built-up land, buildings, railways and names of places.

const kindIs = (kind) => ['==', ['get', 'kind'], kind];
const byZoom = (...stops) => ['interpolate', ['exponential', 1.5], ['zoom'], ...stops];
const flat = (variable, id, source, more = {}) => ({ variable, property: 'fill-color', layer: { id, type: 'fill', 'source-layer': source, paint: { 'fill-antialias': true }, ...more } });
const line = (variable, id, source, width, more = {}) => ({ variable, property: 'line-color',
  layer: { id, type: 'line', 'source-layer': source, layout: { 'line-cap': 'round', 'line-join': 'round' }, ...more, paint: { 'line-width': width, ...more.paint } } });

// From the lowest to the topmost, below the roads.
const below = [
  flat('--built-up', 'built-up', 'built_up'),
  flat('--meadow', 'meadow', 'green', { filter: kindIs('meadow') }),
  flat('--park', 'park', 'green', { filter: kindIs('park') }),
  flat('--forest', 'forest', 'green', { filter: kindIs('forest') }),
  flat('--water', 'water', 'water', { filter: kindIs('water') }),
  line('--water', 'rivers', 'water', byZoom(8, 0.8, 14, 2, 18, 6), { filter: kindIs('river') }),
  line('--water', 'streams', 'water', byZoom(14, 0.8, 18, 3), { filter: kindIs('stream') }),
  flat('--building', 'buildings', 'buildings', { minzoom: 14.5 }),
  line('--railway', 'railways', 'railways', byZoom(9, 0.6, 14, 1.2, 18, 2.4), { layout: { 'line-cap': 'butt' }, paint: { 'line-dasharray': [4, 3] } }),
];

// Layers below the roads and above them, none if the tiles have no background. `css` gives the theme's colours.
export function backgroundLayers(site, css) {
  if (!site.background) return { below: [], above: [] };
  const places = { id: 'places', type: 'symbol', source: 'roads', 'source-layer': 'places',
    layout: { 'text-field': ['get', 'name'], 'text-font': ['sans-serif'], 'text-size': ['match', ['get', 'rank'], 0, 18, 1, 16, 2, 14, 12], 'text-padding': 6, 'symbol-sort-key': ['get', 'rank'] },
    paint: { 'text-color': css('--ink'), 'text-halo-color': css('--ground'), 'text-halo-width': 1.8 } };
  return { below: below.map(({ variable, property, layer }) => ({ ...layer, source: 'roads', paint: { ...layer.paint, [property]: css(variable) } })), above: [places] };
}

// Gives the layers the colours of the theme.
export function paintBackground(map, css) {
  for (const { variable, property, layer } of below) {
    if (map.getLayer(layer.id)) map.setPaintProperty(layer.id, property, css(variable));
  }
  if (map.getLayer('places')) {
    map.setPaintProperty('places', 'text-color', css('--ink'));
    map.setPaintProperty('places', 'text-halo-color', css('--ground'));
  }
}
