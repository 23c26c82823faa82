// The phone's own database (IndexedDB): settings, trips, chunks of a trip that is being recorded, finished logs.

const stores = {
  settings: undefined, // by name
  trips: { keyPath: 'id' }, // { id, state, begun_ms, draws, ... }
  chunks: { keyPath: ['trip', 'seq'] }, // { trip, seq, motion, fixes, upright }
  logs: { keyPath: 'trip' }, // { trip, blob }: trimmed, as it may leave the phone
};

const done = (request) =>
  new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });

const chunksOf = (trip) => IDBKeyRange.bound([trip, 0], [trip, Infinity]);

export class TripStore {
  #db;

  static async open(name = 'macadam-drive') {
    const request = indexedDB.open(name, 1);
    request.onupgradeneeded = () => {
      for (const [store, options] of Object.entries(stores)) {
        request.result.createObjectStore(store, options);
      }
    };
    const store = new TripStore();
    store.#db = await done(request);
    return store;
  }

  // Runs the work in one transaction that is on the disk when it ends: a dead battery takes nothing of it.
  async #write(names, work) {
    const transaction = this.#db.transaction(names, 'readwrite', { durability: 'strict' });
    const ended = new Promise((resolve, reject) => {
      transaction.oncomplete = resolve;
      transaction.onabort = transaction.onerror = () => reject(transaction.error);
    });
    work((name) => transaction.objectStore(name));
    await ended;
  }

  #read(name, ask) {
    return done(ask(this.#db.transaction(name).objectStore(name)));
  }

  setting(name) {
    return this.#read('settings', (store) => store.get(name));
  }

  setSetting(name, value) {
    return this.setSettings({ [name]: value });
  }

  setSettings(values) {
    return this.#write('settings', (store) => Object.entries(values).forEach(([name, value]) => store('settings').put(value, name)));
  }

  trips() {
    return this.#read('trips', (store) => store.getAll());
  }

  putTrip(trip) {
    return this.#write('trips', (store) => store('trips').put(trip));
  }

  // Replaces the entry of a trip by change(entry), unless the trip was deleted meanwhile or change returns nothing.
  // Returns the new entry; undefined: it was left as it is. dropsLog: deletes the log with the change.
  async changeTrip(id, change, { dropsLog = false } = {}) {
    let changed;
    await this.#write(['trips', 'logs'], (store) => {
      const read = store('trips').get(id);
      read.onsuccess = () => {
        changed = read.result && change(read.result);
        if (changed) {
          store('trips').put(changed);
          if (dropsLog) {
            store('logs').delete(id);
          }
        }
      };
    });
    return changed;
  }

  addChunk(trip, seq, chunk) {
    return this.#write('chunks', (store) => store('chunks').put({ trip, seq, ...chunk }));
  }

  chunks(trip) {
    return this.#read('chunks', (store) => store.getAll(chunksOf(trip)));
  }

  // Replaces the raw chunks of a trip by its log; without a log the trip leaves nothing behind but its entry.
  finish(trip, blob) {
    return this.#write(['trips', 'chunks', 'logs'], (store) => {
      store('trips').put(trip);
      store('chunks').delete(chunksOf(trip.id));
      if (blob) {
        store('logs').put({ trip: trip.id, blob });
      }
    });
  }

  async log(trip) {
    return (await this.#read('logs', (store) => store.get(trip)))?.blob;
  }

  deleteTrip(id) {
    return this.#write(['trips', 'chunks', 'logs'], (store) => {
      store('trips').delete(id);
      store('chunks').delete(chunksOf(id));
      store('logs').delete(id);
    });
  }
}
