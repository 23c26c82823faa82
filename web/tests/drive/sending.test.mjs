// The recorder in Chromium: invitations, sending, and what becomes of trips at the server.
import assert from 'node:assert/strict';
import { after, before, describe, it } from 'node:test';
import { gunzipSync } from 'node:zlib';

import {
  accept, getReady, invitations, linesOf, openLink, phone, play, recorded, recordedAgain, savedFile, send, server,
  setUp, setting, shortDrive, site, start, tap, tearDown, tripsAsked, tripsOn, until,
} from './phone.mjs';
import { eventsOf } from './player.mjs';
import { serveTrips } from './trip_server.mjs';

describe('trips that are sent, and the server that takes them', () => {
  before(setUp);
  after(tearDown);

  it('nothing leaves the phone without a tap; the receipt deletes the trip', async () => {
    const { context, page } = await phone();
    await recorded(page);
    const { bytes } = await savedFile(page);
    assert.ok(!server.asked.some((line) => line.includes('/v1/')), 'asked before a tap');
    server.mood.next = 'lose_answer';
    await context.setOffline(true);
    await page.waitForFunction(() => !navigator.onLine);
    await tap(page, /^Send/);
    await page.getByText('Waits for a network').waitFor();
    assert.ok(!server.asked.some((line) => line.includes('/v1/')));
    await context.setOffline(false); // now it goes; the server has it, but its answer is lost; a second later it is asked for
    await page.getByText('Received by the server and deleted here.').waitFor();
    assert.deepEqual(tripsAsked(server), ['PUT', 'GET']);
    assert.deepEqual(gunzipSync([...server.trips.values()][0]), bytes);
    assert.equal(await page.getByRole('button', { name: /^Save file/ }).count(), 0);
    page.once('dialog', (dialog) => dialog.accept());
    await tap(page, /^Delete at the server/);
    await page.getByText('Deleted at the server.').waitFor();
    assert.equal(server.trips.size, 0);
    await context.close();
  });

  it('an invitation opens the server, leaves no trace in the address, and its link can be opened again', async () => {
    const [invitation] = invitations;
    const closed = await serveTrips(site, { invitations });
    const { context, page } = await phone({ url: closed.url });
    await recorded(page);
    await tap(page, send);
    await page.getByText('The server wants an invitation').waitFor();
    await page.goto(`${closed.url}#invite=${invitation}`); // in the page that is open
    await until(() => setting(page, 'token'), 'the invitation is not exchanged');
    assert.ok(!page.url().includes('#'));
    await tap(page, send);
    await page.getByText('Received by the server').waitFor();
    const token = await setting(page, 'token');
    for (let i = 0; i < 2; ++i) { // soon, and when it can be exchanged no more
      await openLink(page, closed.url, invitation);
      await page.getByText('Your invitation is kept').waitFor();
      assert.equal(await setting(page, 'token'), token);
      closed.spent.add(invitation);
    }
    accept(page);
    await tap(page, /^Delete at the server/);
    await page.getByText('Deleted at the server.').waitFor();
    assert.equal(closed.trips.size, 0);
    await context.close();
    closed.close();
  });

  it('an answer with the token that is lost does not spend the invitation, nor the trip that waits for it', async () => {
    const closed = await serveTrips(site, { invitations });
    const { context, page } = await phone({ url: closed.url });
    await recorded(page);
    closed.mood.token = 'lose_answer';
    await openLink(page, closed.url, invitations[0]);
    await tap(page, send);
    await page.getByText('Waits for a network').waitFor();
    await until(() => closed.tokens.size === 1, 'the server gave no token');
    closed.mood.token = undefined;
    await page.reload();
    await page.getByText('Received by the server').waitFor();
    assert.equal(await setting(page, 'token'), closed.tokens.get(invitations[0]));
    await context.close();
    closed.close();
  });

  it('an invitation of another name takes the place of one that works if the driver says so, and once it is accepted', async () => {
    const [first, second] = invitations;
    const closed = await serveTrips(site, { invitations });
    const { context, page } = await phone({ url: closed.url });
    await getReady(page);
    await openLink(page, closed.url, first);
    await until(() => setting(page, 'token'), 'the invitation is not exchanged');
    const token = await setting(page, 'token');
    page.once('dialog', (dialog) => dialog.dismiss());
    await openLink(page, closed.url, second);
    assert.equal(closed.tokens.has(second), false);
    closed.spent.add(second);
    accept(page);
    await openLink(page, closed.url, second);
    await page.getByText('The server does not take this invitation').waitFor();
    assert.equal(await setting(page, 'token'), token);
    closed.spent.clear();
    accept(page);
    await openLink(page, closed.url, second);
    await until(async () => (await setting(page, 'token')) === closed.tokens.get(second), 'the new one is not kept');
    closed.tokens.delete(second); // revoked: now the other comes without a question
    await openLink(page, closed.url, first);
    await until(async () => (await setting(page, 'token')) === closed.tokens.get(first), 'a token that does not work was kept');
    await context.close();
    closed.close();
  });

  it('a trip is sent compressed, and plain by browsers that cannot compress', async () => {
    for (const [before, type] of [[undefined, 'application/gzip'], [() => { delete globalThis.CompressionStream; }, 'text/csv']]) {
      const own = await serveTrips(site);
      const { context, page } = await phone({ url: own.url, before });
      await recorded(page);
      const { bytes } = await savedFile(page);
      await tap(page, send);
      await page.getByText('Received by the server').waitFor();
      const [body] = own.trips.values();
      assert.deepEqual(own.sentTypes, [type]);
      assert.deepEqual(type === 'text/csv' ? body : gunzipSync(body), bytes);
      assert.ok(type === 'text/csv' || body.length < bytes.length / 2, `${body.length} of ${bytes.length} bytes`);
      await context.close();
      own.close();
    }
  });

  it('a trip that is too large for the server says so in words', async () => {
    const { context, page } = await phone();
    await recorded(page);
    server.mood.next = 413;
    await tap(page, send);
    await page.getByText('too large for the server').waitFor();
    await savedFile(page);
    await context.close();
  });

  it('a trip that waits and is deleted while another is on its way is not sent and does not come back', async () => {
    const own = await serveTrips(site);
    const { context, page, complaints } = await phone({ url: own.url });
    await recorded(page);
    await recordedAgain(page, 2);
    let release;
    own.mood.hold = new Promise((resolve) => { release = resolve; });
    await context.setOffline(true);
    await page.waitForFunction(() => !navigator.onLine);
    await tap(page, send);
    await page.getByText('Waits for a network').waitFor();
    await tap(page, send);
    await page.getByText('Waits for a network').nth(1).waitFor();
    await context.setOffline(false);
    await until(() => own.trips.size === 1, 'none is on its way');
    const waiting = (await tripsOn(page)).find(({ sha256 }) => !own.trips.has(sha256));
    accept(page);
    await page.locator(`#delete-${waiting.id}`).click();
    await until(async () => (await linesOf(page).count()) === 1, 'the line is still there');
    release();
    await page.getByText('Received by the server').waitFor();
    assert.deepEqual((await tripsOn(page)).map(({ state }) => state), ['received']);
    assert.equal(await linesOf(page).count(), 1);
    assert.deepEqual(tripsAsked(own), ['PUT']);
    assert.deepEqual(complaints, []);
    await context.close();
    own.close();
  });

  it('a trip that is deleted while it is on its way is deleted at the server, too', async () => {
    const own = await serveTrips(site);
    const { context, page, complaints } = await phone({ url: own.url });
    await recorded(page);
    let release;
    own.mood.hold = new Promise((resolve) => { release = resolve; });
    await tap(page, send);
    await until(() => own.trips.size === 1, 'it is not on its way');
    accept(page);
    await tap(page, /^Delete/);
    await page.getByText('None yet.').waitFor();
    assert.equal(own.trips.size, 0);
    assert.deepEqual(await tripsOn(page), []);
    release();
    assert.deepEqual(tripsAsked(own), ['PUT', 'DELETE']);
    assert.deepEqual(complaints, []);
    await context.close();
    own.close();
  });

  it('the fate of a trip is told in words, also without a network, and another phone of the name can delete the trip', async () => {
    const closed = await serveTrips(site, { invitations });
    const { context, page, complaints } = await phone({ url: closed.url });
    await openLink(page, closed.url, invitations[0], 'Understood');
    await recorded(page);
    await tap(page, send);
    await page.getByText('It waits there for its evaluation.').waitFor();
    const [sha256] = closed.trips.keys();
    closed.fates.set(sha256, { state: 'refused', reason: 'no position' });
    await page.reload();
    await page.getByText('The server could not use it: no position').waitFor();
    assert.equal(await linesOf(page).count(), 1);
    await page.evaluate(() => navigator.serviceWorker.ready);
    await until(() => page.evaluate(async () => (await (await caches.open('macadam-drive')).keys()).length >= 7), 'the page is not kept');
    await context.setOffline(true);
    await page.reload();
    await page.getByText('The server cannot be reached. This is what it said').waitFor();
    await page.getByText('The server could not use it: no position').waitFor();

    const other = await phone({ url: closed.url });
    closed.owners.set(sha256, invitations[1]);
    closed.fates.set(sha256, { state: 'outside' });
    await getReady(other.page);
    await openLink(other.page, closed.url, invitations[1]);
    await other.page.getByText('Not used: it is outside the map').waitFor();
    await other.page.getByText(/^Sent 1 May 2026/).waitFor();
    accept(other.page);
    await tap(other.page, /^Delete at the server/);
    await other.page.getByText('None yet.').waitFor();
    assert.equal(closed.trips.size, 0);

    await context.setOffline(false);
    await page.getByText('The server has no such trip under your name.').waitFor();
    await tap(page, /^Remove from this list/);
    await page.getByText('None yet.').waitFor();
    assert.deepEqual([...complaints, ...other.complaints], []);
    await Promise.all([context.close(), other.context.close()]);
    closed.close();
  });

  it('a fate that changes leaves the focus where it is', async () => {
    const own = await serveTrips(site);
    const { context, page } = await phone({ url: own.url });
    await recorded(page);
    await tap(page, send);
    await page.getByText('It waits there for its evaluation.').waitFor();
    await page.getByRole('button', { name: /^Delete at the server/ }).focus();
    own.fates.set([...own.trips.keys()][0], { state: 'imported', passes: 61 });
    await page.getByText('Evaluated. Road segments of about 20 m: 61.').waitFor();
    assert.match(await page.evaluate(() => document.activeElement.getAttribute('aria-label')), /^Delete at the server/);
    await context.close();
    own.close();
  });

  it('a phone without an invitation lists its own trips alone, whatever a proxy lets it see', async () => {
    const own = await serveTrips(site);
    const { context, page } = await phone({ url: own.url });
    own.trips.set('0'.repeat(64), Buffer.from('of another'));
    own.owners.set('0'.repeat(64), '');
    await recorded(page);
    await tap(page, send);
    await page.getByText('It waits there for its evaluation.').waitFor();
    assert.equal(await linesOf(page).count(), 1);
    await context.close();
    own.close();
  });

  it('a trip that is to be sent while another is on its way is sent after it', async () => {
    const { context, page } = await phone();
    await recorded(page);
    await start(page);
    await play(page, eventsOf(shortDrive));
    await tap(page, 'End trip');
    await page.getByRole('button', { name: /^Save file/ }).nth(1).waitFor();
    let release;
    const held = new Promise((resolve) => { release = resolve; });
    await page.route('**/v1/trips/*', async (route) => { await held; await route.continue(); });
    await Promise.all([page.waitForRequest('**/v1/trips/*'), tap(page, /^Send/)]);
    await tap(page, /^Send/);
    await until(async () => (await page.getByRole('button', { name: /^Send/ }).count()) === 0, 'the second is not queued');
    release();
    await page.getByText('Received by the server and deleted here.').nth(1).waitFor();
    await context.close();
  });
});
