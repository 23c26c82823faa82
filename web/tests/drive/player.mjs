// Plays a recorded drive to the page: events of motion and positions with the drive's own time stamps, as fast as the page takes
// them. The page has no clock of its own for samples, so that a quarter of an hour takes a second or two.
import { readFileSync } from 'node:fs';
import { gunzipSync } from 'node:zlib';

// Replaces the browser's positions, and its chance by a series that is the same in every run, before the page's own script runs.
export function installPositions() {
  let drawn = 20261125;
  crypto.getRandomValues = (array) => {
    for (let i = 0; i < array.length; ++i) {
      drawn = (Math.imul(drawn, 1664525) + 1013904223) >>> 0; // Numerical Recipes' generator
      array[i] = array.BYTES_PER_ELEMENT === 1 ? drawn >>> 24 : drawn;
    }
    return array;
  };
  globalThis.played = { position: null, watches: 0 };
  Object.defineProperty(navigator, 'geolocation', {
    value: {
      watchPosition: (onPosition, onError) => {
        Object.assign(globalThis.played, { position: onPosition, error: onError });
        return ++globalThis.played.watches;
      },
      clearWatch: () => { globalThis.played.position = null; },
    },
  });
}

// Reads a trip log: { columns, rows } with NaN as null.
export function readLog(bytes) {
  const text = (bytes[0] === 0x1f ? gunzipSync(bytes) : bytes).toString();
  const lines = text.split('\n').filter((line) => line !== '' && !line.startsWith('#'));
  const columns = lines[0].split(',');
  return { columns, rows: lines.slice(1).map((line) => line.split(',').map((cell) => (cell === '' ? null : Number(cell)))) };
}
export const readLogFile = (file) => readLog(readFileSync(file));

// The phone's rotation in the car: rows are the phone's axes in those of the car (x ahead, y left, z up). It stands upright in a
// holder, leaning back by 20 degrees, the screen towards the driver.
const lean = (20 * Math.PI) / 180;
const phone = [[0, -1, 0], [Math.sin(lean), 0, Math.cos(lean)], [-Math.cos(lean), 0, Math.sin(lean)]];
const turned = (v) => phone.map((axis) => axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]);

// Events of a log: [t_s, 0, force x y z, rate x y z] or [t_s, 1, lat, lon, speed, course, accuracy].
export function eventsOf({ columns, rows }, { step = 1, quantum_mps2 = 0 } = {}) {
  const at = Object.fromEntries(columns.map((name, i) => [name, i]));
  const round = (value) => (quantum_mps2 > 0 ? Math.round(value / quantum_mps2) * quantum_mps2 : value);
  const cells = (row, names) => names.map((name) => row[at[name]] ?? 0);
  const events = [];
  let next_s = 0;
  for (const row of rows) {
    const t_s = row[at.t_s];
    if (row[at.acc_z_mps2] !== null && t_s >= next_s) {
      next_s = step === 1 ? 0 : t_s + step;
      events.push([t_s, 0, ...turned(cells(row, ['acc_x_mps2', 'acc_y_mps2', 'acc_z_mps2'])).map(round),
        ...turned(cells(row, ['gyro_x_radps', 'gyro_y_radps', 'gyro_z_radps']))]);
    }
    if (row[at.lat_deg] !== null) {
      events.push([t_s, 1, ...['lat_deg', 'lon_deg', 'gnss_speed_mps', 'course_deg', 'hacc_m'].map((name) => row[at[name]])]);
    }
  }
  return events;
}

// Runs in the page. The stamps of events can be replaced although browsers set them, since they are properties of a prototype.
// events: as JSON, which is handed over faster than values are.
export async function playEvents({ events: text, begin_ms, pause_ms = 0 }) {
  const events = JSON.parse(text);
  const degPerRad = 180 / Math.PI;
  const up = new Event('deviceorientation');
  Object.assign(up, { alpha: 0, beta: 70, gamma: 0 });
  dispatchEvent(up);
  for (const [i, [t_s, kind, ...values]] of events.entries()) {
    if (kind === 0) {
      const [x, y, z, alpha, beta, gamma] = values;
      const event = new DeviceMotionEvent('devicemotion', {
        accelerationIncludingGravity: { x, y, z },
        rotationRate: { alpha: alpha * degPerRad, beta: beta * degPerRad, gamma: gamma * degPerRad },
        interval: 10,
      });
      Object.defineProperty(event, 'timeStamp', { value: begin_ms + 1000 * t_s });
      dispatchEvent(event);
    } else {
      const [latitude, longitude, speed, heading, accuracy] = values;
      globalThis.played.position({
        timestamp: performance.timeOrigin + begin_ms + 1000 * t_s,
        coords: { latitude, longitude, speed, heading, accuracy, altitude: null, altitudeAccuracy: null },
      });
    }
    if (i % 1000 === 999) {
      await new Promise((later) => { setTimeout(later, pause_ms); });
    }
  }
}
