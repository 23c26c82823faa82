import { keptTimes, placesOf, trimmed_m } from './trimming.js';
import { Odometer } from './odometer.js';
import { plausible } from './places.js';
import { fixColumn, motionWidth, rowsOf } from './samples.js';

// Writes the format 'macadam-trip 1' (docs/reference/trip-logs.md).

const columns = [
  ['acc_x_mps2', 5], ['acc_y_mps2', 5], ['acc_z_mps2', 5],
  ['gyro_x_radps', 6], ['gyro_y_radps', 6], ['gyro_z_radps', 6],
  ['lat_deg', 8], ['lon_deg', 8], ['alt_m', 2], ['hacc_m', 2], ['vacc_m', 2],
  ['gnss_speed_mps', 4], ['course_deg', 4], ['gnss_utc_s', 3],
];
const motionCells = 6;

const oneLine = (text) => String(text).replace(/[\r\n\0]+/g, ' ').trim();

const cell = (value, decimals) => (Number.isFinite(value) ? value.toFixed(decimals) : '');

const isAny = (values) => values.some(Number.isFinite);

// Rows { t_us, cells } of one stream, by time; of two of one time the first stays.
function increasing(rows) {
  rows.sort((a, b) => a.t_us - b.t_us);
  return rows.filter((row, i) => i === 0 || row.t_us !== rows[i - 1].t_us);
}

function motionRows(motion, isKept, sign) {
  const withGravity = [...rowsOf(motion, motionWidth)].some((row) => Number.isFinite(row[1]));
  const first = withGravity ? 1 : 4;
  const rows = [];
  for (const row of rowsOf(motion, motionWidth)) {
    const cells = [sign * row[first], sign * row[first + 1], sign * row[first + 2], row[7], row[8], row[9]];
    if (isKept(row[0]) && isAny(cells)) {
      rows.push({ t_us: Math.round(row[0] * 1000), cells });
    }
  }
  return { withGravity, rows: increasing(rows) };
}

// Without jumps of the receiver: they may show a place that the trip did not pass.
function fixRows(fixes, isKept) {
  const rows = plausible(placesOf(fixes)).map(({ t_ms, row }) => ({
    t_us: Math.round(t_ms * 1000),
    cells: [
      row[fixColumn.lat], row[fixColumn.lon], row[fixColumn.alt], row[fixColumn.accuracy], row[fixColumn.altAccuracy],
      row[fixColumn.speed], row[fixColumn.course], row[fixColumn.stamp_ms] / 1000,
    ],
  }));
  return increasing(rows.filter((row) => isKept(row.t_us / 1000)));
}

function length_m(rows) {
  const odometer = new Odometer();
  for (const { t_us, cells: [lat, lon, , accuracy_m] } of rows) {
    odometer.add({ t_ms: t_us / 1000, lat, lon, accuracy_m });
  }
  return odometer.length_m;
}

function headerLines(meta, t0_ms, withGravity) {
  const lines = [['trip_id', meta.trip_id], ['vehicle_id', meta.vehicle_id], ['t0_utc', new Date(t0_ms).toISOString()],
    ['frame', 'sensor'], ['gravity', withGravity ? 'included' : 'removed'], ['mount', 'auto'],
    ['speed_source', 'gnss'], ['trimmed_m', trimmed_m], ['car_body', meta.car?.body], ['car_mass_kg', meta.car?.mass_kg],
    ['car_wheelbase_m', meta.car?.wheelbase_m], ['recorder', 'macadam drive 1'], ['device', meta.device]];
  return lines.filter(([, value]) => value !== undefined && value !== null && value !== '')
    .map(([key, value]) => `# ${key}: ${oneLine(value)}\n`);
}

// Writes the kept parts of a trip; null if nothing of it may leave the phone.
//
// recorded: { motion, fixes, upright } (recording.js); meta: { trip_id, vehicle_id, car, device, draws }.
// Returns { parts: text in order, rows, length_m, begin_ms, end_ms }.
export function tripLog(recorded, meta) {
  const kept = keptTimes(recorded.fixes, meta.draws);
  const isKept = (t_ms) => kept.some(([from_ms, to_ms]) => t_ms >= from_ms && t_ms <= to_ms);
  const { withGravity, rows: motion } = motionRows(recorded.motion, isKept, recorded.upright < 0 ? -1 : 1);
  const fixes = fixRows(recorded.fixes, isKept);
  if (motion.length === 0 || fixes.length === 0) {
    return null;
  }
  const begin_us = Math.min(motion[0].t_us, fixes[0].t_us);
  const t0_us = Math.floor(begin_us / 1000) * 1000;
  const isUsed = columns.map((_, i) => i < motionCells
    ? motion.some((row) => Number.isFinite(row.cells[i]))
    : fixes.some((row) => Number.isFinite(row.cells[i - motionCells])));
  const used = columns.flatMap((column, i) => (isUsed[i] ? [i] : []));
  const parts = ['# macadam-trip 1\n', ...headerLines(meta, t0_us / 1000, withGravity),
    `${['t_s', ...used.map((i) => columns[i][0])].join(',')}\n`];
  let count = 0;
  let block = '';
  for (let m = 0, f = 0; m < motion.length || f < fixes.length; ++count) {
    const t_us = Math.min(motion[m]?.t_us ?? Infinity, fixes[f]?.t_us ?? Infinity);
    const acc = motion[m]?.t_us === t_us ? motion[m++].cells : [];
    const fix = fixes[f]?.t_us === t_us ? fixes[f++].cells : [];
    const cells = used.map((i) => cell(i < motionCells ? acc[i] : fix[i - motionCells], columns[i][1]));
    block += `${((t_us - t0_us) / 1e6).toFixed(6)},${cells.join(',')}\n`;
    if (block.length > 1 << 16) {
      parts.push(block);
      block = '';
    }
  }
  parts.push(block, `# end rows: ${count}\n`);
  const last_us = Math.max(motion.at(-1).t_us, fixes.at(-1).t_us);
  return { parts, rows: count, length_m: length_m(fixes), begin_ms: begin_us / 1000, end_ms: last_us / 1000 };
}
