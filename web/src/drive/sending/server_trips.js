import { deleteAtServer, listAtServer } from './upload.js';

const maxListed = 1000; // of an answer
const pauses_s = [5, 10, 20, 60, 300];

const isPending = ({ state }) => ['queued', 'working', 'deleting'].includes(state);

// Trips at the server as it last told, kept on the phone: { trips, asked_ms, isWhole }.
export class ServerTrips {
  problem = null; // of the last request: unreachable, no_leave
  #timer;
  #last = Promise.resolve();

  // onChange(): called after each answer.
  constructor(store, base, onChange) {
    this.store = store;
    this.base = base;
    this.onChange = onChange;
  }

  async known() {
    return (await this.store.setting('at_server')) ?? { trips: [], asked_ms: 0, isWhole: false };
  }

  // Asks the server, unless this phone has sent it nothing; again while it works on a trip. polls: those before.
  refresh(polls = 0) {
    clearTimeout(this.#timer);
    return this.#inTurn(async () => {
      const isWorking = await this.#ask();
      await this.onChange();
      clearTimeout(this.#timer);
      if (isWorking && !document.hidden) {
        this.#timer = setTimeout(() => this.refresh(polls + 1), 1000 * pauses_s[Math.min(polls, pauses_s.length - 1)]);
      }
    });
  }

  // Returns gone, deleting, missing, or undefined (upload.js).
  delete(sha256) {
    return this.#inTurn(async () => {
      const fate = await deleteAtServer(sha256, { token: await this.store.setting('token'), base: this.base });
      if (fate) {
        const known = await this.known();
        const trips = fate === 'deleting'
          ? known.trips.map((trip) => (trip.sha256 === sha256 ? { ...trip, state: fate } : trip))
          : known.trips.filter((trip) => trip.sha256 !== sha256);
        await this.store.setSetting('at_server', { ...known, trips });
      }
      return fate;
    });
  }

  // One request after the other: an answer that is late overwrites no newer one.
  #inTurn(work) {
    const next = this.#last.then(work);
    this.#last = next.catch(() => {});
    return next;
  }

  // Returns whether the server works on a trip. A phone without a token is let in by a proxy, perhaps to see the trips of
  // all: it keeps those that it sent.
  async #ask() {
    const token = await this.store.setting('token');
    const sent = new Set((await this.store.trips()).filter(({ told_ms, state }) => told_ms || state === 'received').map(({ sha256 }) => sha256));
    if (!isSecureContext || (!token && sent.size === 0)) {
      return false;
    }
    const asked_ms = Date.now();
    const { trips: all, problem = 'unreachable' } = navigator.onLine ? await listAtServer({ token, base: this.base }) : {};
    this.problem = all ? null : problem;
    if (!all) {
      return false;
    }
    const trips = token ? all : all.filter(({ sha256 }) => sent.has(sha256));
    await this.store.setSetting('at_server', { trips, asked_ms, isWhole: all.length < maxListed });
    return trips.some(isPending);
  }
}

// State of a trip that was sent, or its fate at the server: { state, row }.
function fateOf(trip, row, { asked_ms, isWhole }) {
  if (!['received', 'deleting'].includes(trip.state)) {
    return { state: trip.state };
  }
  if (row || !isWhole || asked_ms <= (trip.told_ms ?? 0)) {
    return { state: trip.state, row };
  }
  return { state: trip.state === 'deleting' ? 'gone' : 'missing' };
}

// One entry for each trip on the phone or at the server, the latest first: with `row`, what the server says of it. Those
// that the phone does not have are `elsewhere`.
export function mergedTrips(trips, known) {
  const rows = new Map(known.trips.map((row) => [row.sha256, row]));
  const here = new Set(trips.map(({ sha256 }) => sha256));
  const others = known.trips.filter(({ sha256 }) => !here.has(sha256));
  return [
    ...trips.filter(({ state }) => state !== 'recording').map((trip) => ({ ...trip, ...fateOf(trip, rows.get(trip.sha256), known) })),
    ...others.map((row) => ({
      id: row.sha256, sha256: row.sha256, state: 'elsewhere', begun_ms: Date.parse(row.received), bytes: row.bytes, row,
    })),
  ].sort((a, b) => b.begun_ms - a.begun_ms);
}
