import { say, words } from '../page.js';
import { acceptInvitation, listAtServer } from './upload.js';

// Takes an invitation (…/drive/#invite=TEXT), which never reaches a server as part of an address. A token that works stays,
// unless the driver wants the new one in its place.
export async function takeInvitation(store, base) {
  const invitation = new URLSearchParams(location.hash.slice(1)).get('invite');
  if (!invitation || !/^[\w.~-]{16,200}$/.test(invitation)) {
    return;
  }
  const token = await store.setting('token');
  const isInUse = token && (await listAtServer({ token, base })).problem !== 'no_leave';
  const isSame = invitation === (await store.setting('accepted'));
  const isWanted = !isInUse || (!isSame && confirm(words('confirm_invitation')));
  if (isWanted) {
    await store.setSetting('invitation', invitation);
  }
  if (isWanted || isSame) {
    say(words('invited'));
  }
  history.replaceState(null, '', location.pathname);
  await acceptWaitingInvitation(store, base);
}

// Gets the token of an invitation; until then the one before is kept. Returns whether an invitation still waits for a
// network.
export async function acceptWaitingInvitation(store, base) {
  if (!isSecureContext) {
    return false;
  }
  return navigator.locks.request('macadam-drive-invitation', async () => {
    const invitation = await store.setting('invitation');
    if (!invitation) {
      return false;
    }
    const token = navigator.onLine ? await acceptInvitation(invitation, { base }) : undefined;
    if (token === undefined) {
      return true;
    }
    if (token === null) {
      await store.setSetting('invitation', null);
      say(words('invitation_refused'));
    } else {
      await store.setSettings({ token, accepted: invitation, invitation: null, at_server: null });
    }
    return false;
  });
}
