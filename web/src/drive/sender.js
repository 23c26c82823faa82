import { acceptWaitingInvitation } from './invitation.js';
import { say, showAgain, shows, words } from './page.js';
import { sendQueued } from './trips.js';

// Sends what the driver has given leave to send. Only one page of several does it at a time.
export class Sender {
  #isSending = false;
  #isWanted = false; // again, once what is being sent is through
  #timer;

  constructor(store, base) {
    this.store = store;
    this.base = base;
  }

  async send() {
    this.#isWanted = this.#isSending;
    if (this.#isSending || !navigator.onLine || !isSecureContext) {
      return;
    }
    this.#isSending = true;
    clearTimeout(this.#timer);
    try {
      await acceptWaitingInvitation(this.store, this.base);
      const again_s = await navigator.locks.request('macadam-drive-send', () => this.#sendQueued());
      if (again_s !== null) {
        this.#timer = setTimeout(() => this.send(), again_s * 1000);
      }
    } finally {
      this.#isSending = false;
    }
    if (shows('ul.trips')) {
      await showAgain();
    }
    if (this.#isWanted) {
      await this.send();
    }
  }

  async #sendQueued() {
    return sendQueued(this.store, {
      token: await this.store.setting('token'),
      base: this.base,
      onChange: (trip, state) => say(state === 'sending' ? words('state_sending') : ''),
    });
  }
}
