import { say, words } from './page.js';
import { acceptInvitation } from './upload.js';

// Takes an invitation (…/drive/#invite=TEXT), which never reaches a server as part of an address.
export async function takeInvitation(store, base) {
  const invitation = new URLSearchParams(location.hash.slice(1)).get('invite');
  if (invitation && /^[\w.~-]{16,200}$/.test(invitation)) {
    await store.setSetting('token', invitation); // which it may be already
    await store.setSetting('invitation', invitation);
    history.replaceState(null, '', location.pathname);
    say(words('invited'));
    await acceptWaitingInvitation(store, base);
  }
}

// Gets the token of an invitation, now or when there is a network.
export async function acceptWaitingInvitation(store, base) {
  const invitation = await store.setting('invitation');
  const token = invitation && navigator.onLine ? await acceptInvitation(invitation, { base }) : undefined;
  if (token !== undefined) {
    await store.setSetting('token', token ?? invitation);
    await store.setSetting('invitation', null);
  }
}
