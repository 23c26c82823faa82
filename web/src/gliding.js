// Panning where no graphics card draws: drawing a city takes a tenth of a second there. The map is drawn larger than it is seen
// (`.glides` in site.css), and while it moves its picture is moved, and drawn anew when that leaves a border blank, or at rest.

const mostScale = 2;
const mostPixels = 4096; // a side; the library draws larger pictures blurred

// Whether software draws, by the name that the browser gives of what draws, and can draw the margin as well.
export function glides(map) {
  const { gl } = map.painter.context;
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const { width, height } = map.getCanvas();
  return Math.max(width, height) * 1.6 <= mostPixels
    && /swiftshader|llvmpipe|softpipe|software|basic render/i.test(gl.getParameter(names?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER));
}

// The part of a map's picture that is seen, in its pixels.
export function seenBox(map) {
  const { offsetLeft, offsetTop, parentElement } = map.getContainer();
  return { left: -offsetLeft, top: -offsetTop, right: parentElement.clientWidth - offsetLeft, bottom: parentElement.clientHeight - offsetTop };
}

// Where the picture that was drawn of `center` and `zoom` lies now; null if it does not fill what is seen.
function placeOfPicture(map, { center, zoom }) {
  const { left, top, right, bottom } = seenBox(map);
  const [x, y] = [left + right, top + bottom]; // of the picture
  const at = map.project(center);
  const [dx, dy] = [at.x - x / 2, at.y - y / 2].map((px) => Math.round(px * 100) / 100);
  const scale = 2 ** (map.getZoom() - zoom);
  const fills = scale <= mostScale && scale * x / 2 - Math.abs(dx) >= x / 2 - left && scale * y / 2 - Math.abs(dy) >= y / 2 - top;
  return fills ? `translate(${dx}px, ${dy}px) scale(${scale})` : null;
}

// Lets a map glide while `leader`, which it may follow, moves.
export function letGlide(map, leader = map) {
  const canvas = map.getCanvas();
  canvas.getBoundingClientRect = () => canvas.parentElement.getBoundingClientRect(); // the library asks where the pointer is in it
  let drawn = null;
  const forget = () => { drawn = null; };
  const takeOver = () => {
    const draw = map.painter.render.bind(map.painter);
    map.painter.render = (...what) => {
      const isDone = drawn && (drawn.isWhole || !map.isStyleLoaded());
      const place = isDone && leader.isMoving() ? placeOfPicture(map, drawn) : null;
      canvas.style.transform = place ?? '';
      if (place !== null) return;
      drawn = { center: map.getCenter(), zoom: map.getZoom(), isWhole: map.isStyleLoaded() };
      draw(...what);
    };
    forget();
  };
  const rest = () => map.triggerRepaint();
  takeOver();
  map.on('webglcontextrestored', takeOver);
  map.on('resize', forget);
  leader.on('moveend', rest);
  map.on('remove', () => leader.off('moveend', rest));
  map.getContainer().classList.add('glides');
}
