import { fixColumn } from './samples.js';

// Limits of what a trip can be used for.
const minRate_hz = 45; // wheel hop at 10 to 15 Hz needs three to four readings a cycle
const poorAccuracy_m = 20; // two roads apart
const staleFix_ms = 10_000;
const silent_ms = 2000;
const moved_deg = 20; // as `sensor_moved` of the import; hills and bends stay below
const handheld_radps = 0.3; // rms about the level axes: bodies of cars stay below 0.1
const window_ms = 5000;

const norm = (v) => Math.hypot(...v);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const angle_deg = (a, b) => (Math.acos(Math.max(-1, Math.min(1, dot(a, b) / (norm(a) * norm(b))))) * 180) / Math.PI;
const meanOf = (rows, from) => [0, 1, 2].map((k) => rows.reduce((sum, row) => sum + row[from + k], 0) / rows.length);

// Watches the last seconds of a trip and tells what they are good for.
//
// Times of samples are their own; `now_ms` and `heard` come of the caller's clock and only tell silence.
export class QualityWatch {
  #rows = [];
  #fix = null;
  #reference = null;
  #heard = { motion_ms: NaN, fix_ms: NaN };

  addMotion(row, now_ms) {
    this.#heard.motion_ms = now_ms;
    this.#rows.push(row);
    while (row[0] - this.#rows[0][0] > window_ms || row[0] < this.#rows[0][0]) {
      this.#rows.shift();
    }
  }

  addFix(row, now_ms) {
    this.#heard.fix_ms = now_ms;
    this.#fix = row;
  }

  // Returns { rate_hz, accuracy_m, speed_mps, tilt_deg, isSteady, problems }; problems are keys of words.js.
  assess(now_ms, { isHidden = false } = {}) {
    const rows = this.#rows;
    const problems = [];
    const isSilent = !(now_ms - this.#heard.motion_ms < silent_ms);
    const span_ms = rows.length > 1 ? rows.at(-1)[0] - rows[0][0] : 0;
    const rate_hz = isSilent || span_ms <= 0 ? 0 : ((rows.length - 1) * 1000) / span_ms;
    if (isHidden) {
      problems.push('hidden');
    }
    if (isSilent) {
      problems.push('no_motion');
    } else if (span_ms > window_ms / 2 && rate_hz < minRate_hz) {
      problems.push('slow_motion');
    }
    const hasFix = this.#fix !== null && now_ms - this.#heard.fix_ms < staleFix_ms;
    const accuracy_m = hasFix ? this.#fix[fixColumn.accuracy] : NaN;
    const speed_mps = hasFix ? this.#fix[fixColumn.speed] : NaN;
    if (!hasFix) {
      problems.push('no_gnss');
    } else if (!(accuracy_m <= poorAccuracy_m)) {
      problems.push('poor_gnss');
    }
    const mounting = this.#mounting(span_ms);
    problems.push(...(isSilent ? [] : mounting.problems));
    return { rate_hz, accuracy_m, speed_mps, tilt_deg: mounting.tilt_deg, isSteady: mounting.problems.length === 0, problems };
  }

  #mounting(span_ms) {
    const forces = this.#rows.filter((row) => Number.isFinite(row[1]));
    if (forces.length === 0 || span_ms < window_ms / 2) {
      return { tilt_deg: NaN, problems: [] };
    }
    const up = meanOf(forces, 1);
    const problems = [];
    const turns = this.#rows.filter((row) => Number.isFinite(row[7])).map((row) => row.slice(7, 10));
    if (turns.length > 0) {
      const level = turns.map((turn) => norm(turn) ** 2 - (dot(turn, up) / norm(up)) ** 2);
      const rms = Math.sqrt(Math.max(0, level.reduce((sum, value) => sum + value, 0) / level.length));
      if (rms > handheld_radps) {
        problems.push('handheld');
      }
    }
    if (this.#reference && angle_deg(up, this.#reference) > moved_deg) {
      problems.push('moved');
    } else if (problems.length === 0) { // follows slowly: one that is put elsewhere is the new reference by a tap
      this.#reference ??= up;
    }
    return { tilt_deg: angle_deg(up, [0, 0, Math.sign(up[2]) || 1]), problems };
  }

  // Takes the place that the phone has now for the right one.
  forgetMounting() {
    this.#reference = null;
  }
}
