// All roads as an image, where the map will draw them, until it has: the map's library takes seconds on slow machines.
import { el } from './dom.js';
import { state } from './state.js';

const mercator = (lon, lat) => ({ x: (lon + 180) / 360, y: 0.5 - Math.log(Math.tan(Math.PI / 4 + lat * Math.PI / 360)) / (2 * Math.PI) });
const corners = ([west, south, east, north]) => [mercator(west, north), mercator(east, south)];

// Bounds that are not flat, as those of a straight road are.
export function roomy([west, south, east, north]) {
  const [lon, lat, least] = [(west + east) / 2, (south + north) / 2, 0.001]; // degrees
  return [Math.min(west, lon - least), Math.min(south, lat - least), Math.max(east, lon + least), Math.max(north, lat + least)];
}

// Room around what is shown, less where the map is small: more than its size would leave the map where it is.
export function paddingIn(container, { right, bottom }, most) {
  const edge = Math.min(most, container.clientWidth / 8, container.clientHeight / 8);
  return { top: edge, left: edge, right: edge + right, bottom: edge + bottom };
}

export const firstPadding = 30; // pixels

// Only what the map shows first: all roads by their roughness, in the view that fits them.
const isShown = () => state.map === '' && state.mode === 'roughness' && state.c === '' && state.h === '' && Number(state.p) <= 1;

const themeOf = () => {
  if (state.theme === 'auto') return matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
  return state.theme;
};

// Returns a function that takes the image away.
export function showFirstPicture(container, { first_picture: bounds, bounds: roads }, covered) {
  const theme = themeOf();
  if (!bounds || !isShown() || theme === 'contrast') return () => {};
  const pad = paddingIn(container, covered, firstPadding);
  const [from, to] = corners(roomy(roads));
  const room = { x: container.clientWidth - pad.left - pad.right, y: container.clientHeight - pad.top - pad.bottom };
  const world = Math.min(room.x / (to.x - from.x), room.y / (to.y - from.y)); // pixels around the earth
  const left = pad.left + (room.x - world * (to.x - from.x)) / 2;
  const top = pad.top + (room.y - world * (to.y - from.y)) / 2;
  const [begin, end] = corners(bounds);
  const image = el('img', { class: 'first-picture', src: `first_${theme}.png`, alt: '' });
  for (const [name, px] of [['left', left + world * (begin.x - from.x)], ['top', top + world * (begin.y - from.y)], ['width', world * (end.x - begin.x)], ['height', world * (end.y - begin.y)]]) {
    image.style[name] = `${px}px`;
  }
  container.append(image);
  return () => image.remove();
}
