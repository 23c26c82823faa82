import { distance_m, median } from './geometry.js';
import { believed, fixError_m, fixesInRow, isReachable, placeOf } from './places.js';
import { fixColumn, fixWidth, rowsOf } from './samples.js';

// The rule that `macadam import` follows for cars of other people (docs/privacy.md): 300 m and a random 0 to
// 200 m more are left out at both ends and on both sides of every stop, or silence, of more than five minutes.
// Here the length counts by air alone: travel is never shorter. Places before and after a jump that stays are hidden, too:
// one of them may be where the trip began.
export const trimmed_m = 300;
const random_m = 200;
const longStop_ms = 300_000;
const still_m = 50; // a receiver at rest wanders
const samePlace_m = 5; // fixes that determine the place of an end
const receiverLatency_ms = 3000; // at most: the car is further on than its fix says

export const drawCount = 32;

// Times of fixes on the sensors' clock. The receiver's own stamps have the better spacing, the times of arrival the
// right clock: stamps are shifted by the median delay of the fixes near them. What the delay itself is, the import
// estimates (gnss_latency_s).
export function fixTimes_ms(fixes) {
  const near = 30;
  const delays = [...rowsOf(fixes, fixWidth)].map((row) => row[fixColumn.t_ms] - row[fixColumn.stamp_ms]);
  return delays.map((_, i) => {
    const around = delays.slice(Math.max(0, i - near), i + near + 1).filter(Number.isFinite);
    return fixes[i * fixWidth + fixColumn.stamp_ms] + (around.length > 0 ? median(around) : 0);
  });
}

// All fixes as places, in the order of time.
export function placesOf(fixes) {
  const times_ms = fixTimes_ms(fixes);
  return [...rowsOf(fixes, fixWidth)].map((row, i) => placeOf(row, times_ms[i])).sort((a, b) => a.t_ms - b.t_ms);
}

// Index past the fixes that stay at the place of fix `anchor`.
function endOfStay(places, anchor) {
  let away = 0;
  for (let i = anchor + 1; i < places.length; ++i) {
    away = distance_m(places[anchor], places[i]) < still_m ? 0 : away + 1;
    if (away === fixesInRow) {
      return i - (fixesInRow - 1);
    }
  }
  return places.length - away;
}

// Ranges [first, last] of fixes during long stops; the first and the last fix of the trip are such places too.
function hiddenRanges(places) {
  const ranges = [[0, 0]];
  for (let anchor = 0; anchor < places.length; ) {
    const past = endOfStay(places, anchor);
    if (places[past - 1].t_ms - places[anchor].t_ms > longStop_ms) {
      ranges.push([anchor, past - 1]);
      anchor = past;
    } else {
      ++anchor;
    }
  }
  for (let i = 1; i < places.length; ++i) {
    if (places[i].t_ms - places[i - 1].t_ms > longStop_ms || !isReachable(places[i - 1], places[i])) {
      ranges.push([i - 1, i]);
    }
  }
  ranges.push([places.length - 1, places.length - 1]);
  return ranges.sort((a, b) => a[0] - b[0]);
}

// Index of the first fix, going by `step` from `from`, from which the fixes stay `length_m` away; null: they never do.
function firstAway(places, from, step, length_m) {
  const around = [];
  for (let i = from; i >= 0 && i < places.length; i += step) {
    if (distance_m(places[from], places[i]) < samePlace_m) {
      around.push(places[i]);
    } else {
      break;
    }
  }
  const hidden = { lat: median(around.map((p) => p.lat)), lon: median(around.map((p) => p.lon)) };
  let inRow = 0;
  for (let i = from; i >= 0 && i < places.length; i += step) {
    const isAway = distance_m(hidden, places[i]) >= length_m + fixError_m + places[i].accuracy_m;
    inRow = isAway ? inRow + 1 : 0;
    if (inRow === fixesInRow) {
      return i - step * (fixesInRow - 1);
    }
  }
  return null;
}

// Returns the times [from_ms, to_ms] of a trip that may leave the phone, in order; none if the trip is too short.
//
// draws: numbers in [0, 1), drawn once for each trip, so that a second look tells no more than the first.
export function keptTimes(fixes, draws) {
  const places = believed(placesOf(fixes));
  if (places.length === 0) {
    return [];
  }
  const length_m = (n) => trimmed_m + random_m * draws[n % draws.length];
  const hidden = hiddenRanges(places);
  const kept = [];
  for (let i = 1; i < hidden.length; ++i) {
    const [begin, end] = [hidden[i - 1][1], hidden[i][0]];
    const first = firstAway(places, begin, 1, length_m(2 * i));
    const last = firstAway(places, end, -1, length_m(2 * i + 1));
    if (first === null || last === null || first < begin || last > end) {
      continue;
    }
    const to_ms = places[last].t_ms - receiverLatency_ms;
    if (places[first].t_ms < to_ms) {
      kept.push([places[first].t_ms, to_ms]);
    }
  }
  return kept;
}
