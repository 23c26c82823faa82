import { fixRow, motionRow, upBy, uprightForce } from './samples.js';

const chunk_ms = 2000; // of a trip that a crash may take, with as long again for the disk

// Collects samples and hands them on in chunks of two seconds. It has no clock: times are those of the events.
//
// onChunk({ motion, fixes, upright }): Float64Arrays of rows (samples.js), and the sum of the forces along the
// vertical, whose sign tells that of the browser's accelerations.
export class Recording {
  #motion = [];
  #fixes = [];
  #upright = 0;
  #up = null;
  #begun_ms = null;
  #last_ms = NaN; // of the last motion; NaN once a fix took it, as the sensors may have fallen silent

  constructor({ timeOrigin_ms, onChunk }) {
    this.timeOrigin_ms = timeOrigin_ms;
    this.onChunk = onChunk;
  }

  addMotion(event) {
    const row = motionRow(event, this.timeOrigin_ms);
    this.#last_ms = row[0];
    this.#motion.push(...row);
    if (this.#up && Number.isFinite(row[1])) {
      this.#upright += uprightForce(row, this.#up);
    }
    this.#flushIfFull(row[0]);
    return row;
  }

  addOrientation(event) {
    if (Number.isFinite(event.beta) && Number.isFinite(event.gamma)) {
      this.#up = upBy(event.beta, event.gamma);
    }
  }

  addPosition(position) {
    const row = fixRow(position, this.#last_ms);
    this.#last_ms = NaN;
    this.#fixes.push(...row);
    this.#flushIfFull(Number.isFinite(row[0]) ? row[0] : row[1]);
    return row;
  }

  #flushIfFull(now_ms) {
    this.#begun_ms ??= now_ms;
    if (now_ms - this.#begun_ms >= chunk_ms || now_ms < this.#begun_ms) {
      this.flush();
      this.#begun_ms = now_ms;
    }
  }

  // Hands on what there is; also to be called by a timer, for sensors that fall silent, and when the page is hidden.
  flush() {
    if (this.#motion.length + this.#fixes.length === 0) {
      return;
    }
    this.onChunk({
      motion: Float64Array.from(this.#motion),
      fixes: Float64Array.from(this.#fixes),
      upright: this.#upright,
    });
    this.#motion = [];
    this.#fixes = [];
    this.#upright = 0;
  }
}

// Joins chunks in their order.
export function joined(chunks) {
  const join = (arrays) => {
    const all = new Float64Array(arrays.reduce((size, array) => size + array.length, 0));
    let at = 0;
    for (const array of arrays) {
      all.set(array, at);
      at += array.length;
    }
    return all;
  };
  return {
    motion: join(chunks.map((chunk) => chunk.motion)),
    fixes: join(chunks.map((chunk) => chunk.fixes)),
    upright: chunks.reduce((sum, chunk) => sum + chunk.upright, 0),
  };
}
