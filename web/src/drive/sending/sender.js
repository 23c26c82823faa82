import { acceptWaitingInvitation } from './invitation.js';
import { say, words } from '../page.js';
import { sendQueued } from '../trips.js';

const pauseToAccept_s = 30;

// Sends what the driver has given leave to send. Only one page of several does it at a time.
export class Sender {
  #isSending = false;
  #isWanted = false; // again, once what is being sent is through
  #timer;
  #onWay = { id: null, abort: null };

  // onSent(): called after each round.
  constructor(store, base, onSent) {
    this.store = store;
    this.base = base;
    this.onSent = onSent;
  }

  // Breaks off the sending of a trip, if it is on its way.
  cancel(id) {
    if (id === this.#onWay.id) {
      this.#onWay.abort.abort();
    }
  }

  async send() {
    this.#isWanted = this.#isSending;
    if (this.#isSending || !navigator.onLine || !isSecureContext) {
      return;
    }
    this.#isSending = true;
    clearTimeout(this.#timer);
    try {
      const again_s = await this.#round();
      if (again_s !== null) {
        this.#timer = setTimeout(() => this.send(), again_s * 1000);
      }
    } finally {
      this.#isSending = false;
    }
    await this.onSent();
    if (this.#isWanted) {
      await this.send();
    }
  }

  // Returns when to try again (s); null: nothing waits. Trips wait for the token of an invitation.
  async #round() {
    const isInvited = await acceptWaitingInvitation(this.store, this.base);
    return isInvited ? pauseToAccept_s : navigator.locks.request('macadam-drive-send', () => this.#sendQueued());
  }

  async #sendQueued() {
    return sendQueued(this.store, {
      token: await this.store.setting('token'),
      base: this.base,
      signalOf: (id) => {
        this.#onWay = { id, abort: new AbortController() };
        return this.#onWay.abort.signal;
      },
      onChange: (state) => say(state === 'sending' ? words('state_sending') : ''),
    });
  }
}
