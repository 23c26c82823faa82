// A map of picture tiles, for browsers without WebGL: dragged, by the wheel, by arrows, + and -, and by its buttons.
import { el } from './dom.js';
import { w } from './words.js';

const size = 256;
const most = 16; // zoom
const tries = 4; // a tile may have to wait to be drawn

// Place of a position in the world, 0 to 1 eastwards and southwards.
const placeOf = (longitude, latitude) => ({ x: (longitude + 180) / 360, y: (1 - Math.asinh(Math.tan((latitude * Math.PI) / 180)) / Math.PI) / 2 });
const clamped = (value, low, high) => Math.min(high, Math.max(low, value));

export function pictureMap(template, [west, south, east, north]) {
  const tiles = el('div', { class: 'tiles' });
  const map = el('div', { class: 'pictures', tabIndex: 0, role: 'group', 'aria-label': w('site.overview') }, tiles,
    el('div', { class: 'zoom' },
      el('button', { type: 'button', 'aria-label': w('site.zoom_in'), onclick: () => zoomBy(1) }, '+'),
      el('button', { type: 'button', 'aria-label': w('site.zoom_out'), onclick: () => zoomBy(-1) }, '−')));
  const [first, last] = [placeOf(west, north), placeOf(east, south)];
  const centre = { x: (first.x + last.x) / 2, y: (first.y + last.y) / 2 };
  const shown = new Map();
  let zoom;

  function draw() {
    const { clientWidth: width, clientHeight: height } = map;
    if (!width) return;
    zoom ??= clamped(Math.floor(Math.log2(Math.min(width / size / Math.max(last.x - first.x, 1e-9), height / size / Math.max(last.y - first.y, 1e-9)))), 0, most);
    const world = 2 ** zoom;
    const [left, top] = [Math.round(centre.x * world * size - width / 2), Math.round(centre.y * world * size - height / 2)];
    const wanted = new Set();
    for (let row = Math.max(0, Math.floor(top / size)); row <= Math.min(world - 1, Math.floor((top + height) / size)); row += 1) {
      for (let column = Math.max(0, Math.floor(left / size)); column <= Math.min(world - 1, Math.floor((left + width) / size)); column += 1) {
        const key = `${zoom}/${row}/${column}`;
        wanted.add(key);
        if (!shown.has(key)) shown.set(key, load(zoom, row, column));
        shown.get(key).style.transform = `translate(${column * size - left}px, ${row * size - top}px)`;
      }
    }
    for (const [key, tile] of shown) if (!wanted.has(key)) { tile.remove(); shown.delete(key); }
  }

  function load(z, row, column) {
    const tile = el('img', { alt: '', width: size, height: size, hidden: true });
    tiles.append(tile);
    const url = new URL(template.replace('{z}', z).replace('{y}', row).replace('{x}', column), document.baseURI);
    const ask = async (left) => {
      const response = await fetch(url);
      if (response.status === 200) {
        tile.src = URL.createObjectURL(await response.blob());
        tile.onload = () => { tile.hidden = false; URL.revokeObjectURL(tile.src); };
      } else if (response.status === 503 && left > 0 && tile.isConnected) {
        setTimeout(() => ask(left - 1).catch(() => {}), 1000 * Number(response.headers.get('Retry-After') ?? 2));
      }
    };
    ask(tries).catch(() => {}); // without a network the lists remain
    return tile;
  }

  function move(right, down) {
    const world = size * 2 ** zoom;
    centre.x = clamped(centre.x + right / world, 0, 1);
    centre.y = clamped(centre.y + down / world, 0, 1);
    draw();
  }

  function zoomBy(step) {
    zoom = clamped(zoom + step, 0, most);
    draw();
  }

  map.addEventListener('pointerdown', (event) => {
    if (event.button !== 0 || event.target.closest('button')) return;
    map.setPointerCapture(event.pointerId);
  });
  map.addEventListener('pointermove', (event) => {
    if (map.hasPointerCapture(event.pointerId)) move(-event.movementX, -event.movementY);
  });
  let turned = 0; // when the wheel last zoomed: a touch pad turns it many times a second
  map.addEventListener('wheel', (event) => {
    event.preventDefault();
    if (event.timeStamp - turned < 200) return;
    turned = event.timeStamp;
    zoomBy(event.deltaY < 0 ? 1 : -1);
  }, { passive: false });
  map.addEventListener('keydown', (event) => {
    const step = { ArrowLeft: [-100, 0], ArrowRight: [100, 0], ArrowUp: [0, -100], ArrowDown: [0, 100] }[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey || !(step || '+-='.includes(event.key))) return;
    event.preventDefault();
    if (step) move(...step); else zoomBy(event.key === '-' ? -1 : 1);
  });
  new ResizeObserver(draw).observe(map);
  return map;
}
