import { element } from '../dom.js';
import { button, heading, words } from '../page.js';

// What becomes of a trip, before the first one and whenever the driver asks.
export function privacyView({ store, begin }) {
  const texts = [1, 2, 3, 4, 5, 6].map((n) => element('p', {}, words(`privacy_${n}`)));
  const understood = async () => {
    await store.setSetting('understood', true);
    await begin();
  };
  return [heading('privacy_heading'), ...texts, button('understood', understood, { class: 'main' })];
}
