import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { gzipSync } from 'node:zlib';
import { after, before, describe, test } from 'node:test';
import { join } from 'node:path';
import { csvRows } from '../src/drawer.js';
import { parseId } from '../src/data.js';
import { addFeatures, continuation, newNetwork, routeAlong } from '../src/network.js';
import { served } from './served.mjs';
import { world } from './browser.mjs';

let town;
before(async () => { town = await world(); }, { timeout: 300_000 });
after(() => town?.close());

const km = (text) => Number(/([\d.]+) km/.exec(text)[1]);
const fixed = (value) => value.toFixed(2);

// The first measured segment of a road whose other direction was not measured, and the place of its middle.
function lonely() {
  const names = new Set(town.segments.map(({ segment }) => segment));
  const found = town.segments.find(({ segment, from_m: from, to_m: to }) => to - from > 15 && !names.has(segment.replace(/[+-](?=\d+$)/, (sign) => (sign === '+' ? '-' : '+'))));
  assert.ok(found, 'the fleet drives some road in one direction only');
  const shard = JSON.parse(readFileSync(join(town.folder, 'site/segments/index.json'), 'utf8'));
  for (let i = 0; i < shard.length; ++i) {
    const each = JSON.parse(readFileSync(join(town.folder, `site/segments/${i}.json`), 'utf8'))[found.segment];
    if (each) return { found, detail: each };
  }
  throw new Error(`no shard has ${found.segment}`);
}
const details = () => {
  const read = (name) => JSON.parse(readFileSync(join(town.folder, `site/segments/${name}.json`), 'utf8'));
  return read('index').flatMap((_, i) => Object.values(read(i)));
};
const at = ({ line }, zoom = 18) => `map=${zoom}/${((line[0][1] + line.at(-1)[1]) / 2).toFixed(6)}/${((line[0][0] + line.at(-1)[0]) / 2).toFixed(6)}`;

describe('a site in a folder', { timeout: 300_000 }, () => {
  test('has the fields of every measured segment as query prints them', () => {
    const index = JSON.parse(readFileSync(join(town.folder, 'site/segments/index.json'), 'utf8'));
    const all = index.flatMap((_, i) => Object.values(JSON.parse(readFileSync(join(town.folder, `site/segments/${i}.json`), 'utf8'))));
    assert.ok(all.length > 500);
    assert.deepEqual(all.map(({ line, months, ...fields }) => fields), town.segments);
    assert.ok(all.every(({ months }) => months.length > 0));
  });

  test('has as many kilometres in its totals as in its segments', () => {
    const { rows } = JSON.parse(readFileSync(join(town.folder, 'site/totals.json'), 'utf8'));
    const total = rows.reduce((sum, row) => sum + row[5], 0);
    const measured = town.segments.reduce((sum, { from_m: from, to_m: to }) => sum + (to - from) / 1000, 0);
    assert.ok(Math.abs(total - measured) < 0.05, `${total} and ${measured}: rows are rounded to 0.1 m`);
  });

  test('has own code of at most 80 kB gzipped', () => {
    const sizes = ['assets/site.js', 'assets/site.css', 'drive/drive.js', 'drive/drive.css'].map((name) => gzipSync(readFileSync(join(town.folder, 'site', name))).length);
    assert.ok(sizes.reduce((sum, each) => sum + each) < 80_000, String(sizes));
  });
});

describe('rows of CSV', () => {
  const rows = (name) => csvRows([{ segment: '7+0000', name, trend_per_year: -0.1, months: [], line: [[16, 48]] }], false);

  test('give a spreadsheet no formula, and keep numbers with a sign', () => {
    for (const name of ['=HYPERLINK("http://example.org";"A")', '+1', '-1', '@SUM(A1)', '\t=1', '\r=1']) {
      assert.equal(rows(name), `7+0000,"'${name.replaceAll('"', '""')}",-0.1,16,48\n`);
    }
  });

  test('quote what would end a cell', () => {
    assert.equal(rows('A, "B"\r\nC'), '7+0000,"A, ""B""\r\nC",-0.1,16,48\n');
    assert.equal(rows(null), '7+0000,,-0.1,16,48\n');
  });
});

describe('a network of what tiles have shown', () => {
  const metre = 1 / 111_320; // degrees
  // Segments of 20 m along the equator, as places in metres.
  const segment = (id, from, to, line) => ({ properties: { segment: id, from_m: from, to_m: to, iri: 1, iri_low: 1, iri_high: 1 }, geometry: { type: 'LineString', coordinates: line.map(([x, y]) => [x * metre, y * metre]) } });
  const ids = (route) => route?.map(({ segment: id }) => id) ?? null;

  test('leads the shortest way, against no direction and without turning round', () => {
    const network = newNetwork();
    addFeatures(network, [segment('1+0000', 0, 20, [[0, 0], [20, 0]]), segment('1+0001', 20, 40, [[20, 0], [40, 0]]), segment('1-0000', 0, 20, [[20, 0], [0, 0]]),
      segment('2+0000', 0, 45, [[20, 0], [20, 20], [40, 0]]), segment('3+0000', 0, 20, [[40, 0], [60, 0]])]);
    assert.deepEqual(ids(routeAlong(network, ['1+0000', '3+0000'])), ['1+0000', '1+0001', '3+0000']);
    assert.deepEqual(ids(routeAlong(network, ['1+0000', '2+0000', '3+0000'])), ['1+0000', '2+0000', '3+0000']);
    assert.equal(routeAlong(network, ['3+0000', '1+0000']), null, 'nothing leads back');
  });

  test('joins the parts of a segment that tiles cut, in whatever order they come, and leaves out what is not whole', () => {
    const parts = [segment('1+0000', 0, 20, [[0, 0], [12, 0]]), segment('1+0000', 0, 20, [[8, 0], [20, 0]])];
    for (const order of [parts, [...parts].reverse()]) {
      const network = newNetwork();
      addFeatures(network, [...order, segment('1+0001', 20, 40, [[20, 0], [40, 0]]), segment('1+0002', 40, 60, [[40, 0], [48, 0]])]);
      assert.deepEqual(ids(routeAlong(network, ['1+0000', '1+0001'])), ['1+0000', '1+0001']);
      assert.equal(network.segments.has('1+0002'), false);
    }
  });

  test('takes two ends for one that tiles of other zooms round apart, and not two roads 3 m apart', () => {
    const network = newNetwork();
    addFeatures(network, [segment('1+0000', 0, 20, [[0, 0], [20, 0]]), segment('2+0000', 0, 20, [[20.6, 0.4], [40, 0]]), segment('3+0000', 0, 20, [[20, 3], [40, 3]])]);
    assert.deepEqual(ids(routeAlong(network, ['1+0000', '2+0000'])), ['1+0000', '2+0000']);
    assert.equal(routeAlong(network, ['1+0000', '3+0000']), null);
  });

  test('goes on along a road where its way ends, in its direction, and neither turns round nor guesses at a fork', () => {
    const network = newNetwork();
    const road = (name, ...what) => { const { properties, ...rest } = segment(...what); return { ...rest, properties: { ...properties, name, highway: 'residential' } }; };
    addFeatures(network, [road('A', '1+0000', 0, 20, [[0, 0], [20, 0]]), road('A', '1-0000', 0, 20, [[20, 0], [0, 0]]), road('A', '2-0004', 80, 100, [[20, 0], [40, 0]]), road('A', '2+0004', 80, 100, [[40, 0], [20, 0]]),
      road('B', '3+0000', 0, 20, [[20, 0], [20, 20]]), road('A', '4+0000', 0, 20, [[40, 0], [60, 10]]), road('A', '5+0000', 0, 20, [[40, 0], [60, -10]]),
      road(null, '6+0000', 0, 20, [[0, 90], [20, 90]]), road(undefined, '7+0000', 0, 20, [[20, 90], [40, 90]])]);
    const next = (id, step) => continuation(network, { segment: id }, step);
    assert.equal(next('1+0000', 1), '2-0004');
    assert.equal(next('2-0004', -1), '1+0000');
    assert.equal(next('2+0004', 1), '1-0000');
    assert.equal(next('2-0004', 1), null, 'a fork');
    assert.equal(next('3+0000', 1), null, 'an end');
    assert.equal(next('6+0000', 1), '7+0000', 'roads without a name');
    assert.equal(next('9+0000', 1), null);
  });
});

describe('the page', { timeout: 1000_000 }, () => {
  test('opens the drawer with the numbers of query where the map is clicked', async () => {
    const { found, detail } = lonely();
    const { page, text, close } = await town.page(`#${at(detail)}`);
    const box = await page.locator('#map canvas').boundingBox();
    const [[lon1, lat1], [lon2, lat2]] = [detail.line[0], detail.line.at(-1)];
    const course = Math.atan2((lon2 - lon1) * Math.cos(lat1 * Math.PI / 180), lat2 - lat1);
    const side = 8.2; // pixels to the right in driving direction at zoom 18
    await page.mouse.click(box.x + box.width / 2 + side * Math.cos(course), box.y + box.height / 2 + side * Math.sin(course));
    await page.waitForSelector('.drawer dl');
    const [asked] = town.query('--segment', await text('.drawer code'));
    assert.equal(asked.segment, found.segment);
    assert.equal(await text('.value strong'), fixed(asked.iri));
    const drawer = await text('.drawer');
    assert.ok(drawer.includes(`${fixed(asked.iri_low)} – ${fixed(asked.iri_high)}`), drawer);
    assert.ok(drawer.includes(`${asked.passes} pass`), drawer);
    assert.match(new URL(page.url()).hash, new RegExp(`s=${found.segment.replace('+', '\\+')}`));
    await close();
  });

  test('finds a road within 8 pixels of a mouse and not beyond', async () => {
    const { detail } = lonely();
    const { page, close } = await town.page(`#${at(detail)}`);
    const box = await page.locator('#map canvas').boundingBox();
    const [[lon1, lat1], [lon2, lat2]] = [detail.line[0], detail.line.at(-1)];
    const course = Math.atan2((lon2 - lon1) * Math.cos(lat1 * Math.PI / 180), lat2 - lat1);
    const click = (side) => page.mouse.click(box.x + box.width / 2 + side * Math.cos(course), box.y + box.height / 2 + side * Math.sin(course));
    const edge = 8.2 + 5.5; // right border of the line
    await click(edge + 14);
    await page.waitForTimeout(300);
    assert.equal(await page.locator('.drawer').isVisible(), false);
    await click(edge + 4);
    await page.waitForSelector('.drawer h2');
    await close();
  });

  test('finds a road within 22 pixels of a finger and not beyond', async () => {
    const { detail } = lonely();
    const { page, close } = await town.page(`#${at(detail)}`, { hasTouch: true });
    const box = await page.locator('#map canvas').boundingBox();
    const [[lon1, lat1], [lon2, lat2]] = [detail.line[0], detail.line.at(-1)];
    const course = Math.atan2((lon2 - lon1) * Math.cos(lat1 * Math.PI / 180), lat2 - lat1);
    const edge = 8.2 + 5.5; // right border of the line
    const tap = (side) => page.touchscreen.tap(box.x + box.width / 2 + side * Math.cos(course), box.y + box.height / 2 + side * Math.sin(course));
    await tap(edge + 38);
    await page.waitForTimeout(600);
    assert.equal(await page.locator('.drawer').isVisible(), false);
    await tap(edge + 14);
    await page.waitForSelector('.drawer h2');
    await close();
  });

  test('asks which road is meant where both directions are within reach', async () => {
    const opposite = (segment) => segment.replace(/[+-](?=\d+$)/, (sign) => (sign === '+' ? '-' : '+'));
    const names = new Set(town.segments.map(({ segment }) => segment));
    const index = JSON.parse(readFileSync(join(town.folder, 'site/segments/index.json'), 'utf8'));
    const all = index.flatMap((_, i) => Object.values(JSON.parse(readFileSync(join(town.folder, `site/segments/${i}.json`), 'utf8'))));
    const both = all.find(({ segment, line, from_m: from, to_m: to }) => names.has(opposite(segment)) && line.length === 2 && to - from > 15);
    const { page, text, close } = await town.page(`#${at(both)}`);
    const box = await page.locator('#map canvas').boundingBox();
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    await page.waitForSelector('.drawer .choices');
    assert.ok(await page.locator('.choices button').count() >= 2);
    assert.equal(await page.evaluate(() => document.activeElement.id), 'drawer-title');
    await page.keyboard.press('Tab');
    await page.keyboard.press('Enter');
    await page.waitForSelector('.drawer dl');
    assert.ok([both.segment, opposite(both.segment)].includes(await text('.drawer code')));
    await close();
  });

  // A page that counts what its map draws, by a renderer of that name.
  async function countingPage(hash, renderer) {
    const opened = await town.page(hash, { reducedMotion: 'reduce', before: (page) => page.addInitScript((name) => { // so that it does not roll on
      const { drawElements, getParameter } = WebGL2RenderingContext.prototype;
      globalThis.draws = 0;
      WebGL2RenderingContext.prototype.drawElements = function count(...what) { globalThis.draws += 1; drawElements.apply(this, what); };
      WebGL2RenderingContext.prototype.getParameter = function named(what) { return what === 0x9246 ? name : getParameter.call(this, what); }; // UNMASKED_RENDERER_WEBGL
    }, renderer) });
    const { page } = opened;
    const picture = () => page.evaluate(() => {
      const { e, f, a } = new DOMMatrix(document.querySelector('#map canvas').style.transform);
      return { x: e, y: f, scale: a, draws: globalThis.draws };
    });
    // Waits until the picture lies so far from where it was drawn.
    const moved = (x, y) => page.waitForFunction(([dx, dy]) => {
      const { e, f } = new DOMMatrix(document.querySelector('#map canvas').style.transform);
      return Math.abs(e - dx) < 0.1 && Math.abs(f - dy) < 0.1;
    }, [x, y]);
    return { ...opened, picture, moved };
  }
  const software = 'ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE)), SwiftShader driver)';

  test('moves its picture without drawing it while a map that software draws is dragged, and draws it at rest', async () => {
    const { detail } = lonely();
    const { page, picture, moved, drawn, text, close } = await countingPage(`#${at(detail)}`, software);
    await page.waitForSelector('#map .glides');
    await drawn();
    const seen = await page.locator('#map').boundingBox();
    const zoomIn = await page.getByRole('button', { name: 'Zoom in' }).boundingBox();
    assert.ok(zoomIn.x + zoomIn.width <= seen.x + seen.width && zoomIn.y >= seen.y, 'the controls are in what is seen');
    const [x, y] = [seen.x + seen.width / 2, seen.y + seen.height / 2];
    assert.doesNotMatch(page.url(), /map=18\.00/, 'it has not moved');
    const before = await picture();
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 60, y + 20);
    await moved(60, 20);
    await page.mouse.move(x + 100, y + 40);
    await moved(100, 40);
    assert.equal((await picture()).draws, before.draws, 'nothing is drawn');
    await page.mouse.move(x + seen.width * 0.4, y + 40);
    await page.waitForFunction((draws) => globalThis.draws > draws, before.draws); // a border would be blank
    await page.mouse.move(x + 100, y + 40);
    const again = await picture();
    await page.mouse.up();
    await page.waitForFunction((draws) => globalThis.draws > draws && document.querySelector('#map canvas').style.transform === '', again.draws);
    await drawn();
    const [[lon1, lat1], [lon2, lat2]] = [detail.line[0], detail.line.at(-1)];
    const course = Math.atan2((lon2 - lon1) * Math.cos(lat1 * Math.PI / 180), lat2 - lat1);
    const side = 8.2; // pixels to the right in driving direction at zoom 18
    await page.mouse.click(x + 100 + side * Math.cos(course), y + 40 + side * Math.sin(course));
    await page.waitForSelector('.drawer dl');
    assert.equal(await text('.drawer code'), detail.segment);
    await close();
  });

  test('moves no picture where a graphics card draws', async () => {
    const { page, picture, close } = await countingPage(`#${at(lonely().detail)}`, 'ANGLE (Intel, Mesa Intel(R) UHD Graphics 620 (KBL GT2), OpenGL 4.6)');
    const { x, y, width, height } = await page.locator('#map').boundingBox();
    const before = await picture();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 100, y + height / 2);
    await page.waitForFunction((draws) => globalThis.draws > draws, before.draws);
    const { draws, ...place } = await picture();
    assert.deepEqual(place, { x: 0, y: 0, scale: 1 });
    assert.equal(await page.locator('.glides').count(), 0);
    await page.mouse.up();
    await close();
  });

  test('has the legend in sight on a phone, and raises the sheet for the keyboard', async () => {
    const { page, breaches, close } = await town.page('', { width: 320, height: 640 });
    const sees = (selector) => page.evaluate((name) => {
      const [place, sheet] = [name, '.sheet'].map((each) => document.querySelector(each).getBoundingClientRect());
      return place.height > 0 && place.top >= sheet.top && place.bottom <= sheet.bottom;
    }, selector);
    assert.equal(await sees('.peek'), true);
    await page.setViewportSize({ width: 640, height: 400 }); // a window of 1280 x 800 at 200 %
    assert.equal(await sees('.peek'), true);
    await page.setViewportSize({ width: 320, height: 640 });
    assert.deepEqual(await breaches(), []);
    await page.locator('.handle').focus();
    await page.keyboard.press('Tab');
    assert.equal(await page.locator('.sheet').getAttribute('data-height'), 'half');
    await close();
  });

  test('leaves the map in sight beside the drawer on a tablet, and the keys lead back to the panel', async () => {
    const { page, close } = await town.page(`#s=${lonely().found.segment}`, { width: 768 });
    await page.waitForSelector('.drawer dl');
    const drawer = await page.locator('.drawer').boundingBox();
    assert.ok(768 - drawer.x - drawer.width > 400);
    await page.keyboard.press('w');
    assert.equal(await page.evaluate(() => document.activeElement.closest('tr')?.id), 'worst-1');
    await close();
  });

  test('filters kilometres and map by class, road class, passes and confidence', async () => {
    const { page, text, close } = await town.page();
    const sum = (keeps) => town.segments.filter(keeps).reduce((all, { from_m: from, to_m: to }) => all + (to - from) / 1000, 0);
    assert.ok(Math.abs(km(await text('.total')) - sum(() => true)) < 0.06);
    await page.getByRole('checkbox', { name: /^Poor/ }).uncheck();
    assert.ok(Math.abs(km(await text('.total')) - sum(({ class: name }) => name !== 'poor')) < 0.06);
    await page.getByLabel('Passes, at least').selectOption('2');
    assert.ok(Math.abs(km(await text('.total')) - sum(({ class: name, passes }) => name !== 'poor' && passes >= 2)) < 0.06);
    await page.getByLabel(/^Confidence/).and(page.locator('select')).selectOption('1');
    const isNarrow = ({ iri, iri_low: low, iri_high: high }) => (high - low) / 2 <= 0.3 * iri;
    assert.ok(Math.abs(km(await text('.total')) - sum((each) => each.class !== 'poor' && each.passes >= 2 && isNarrow(each))) < 0.08);
    assert.match(page.url(), /c=poor&p=2&q=1|c=poor.*p=2.*q=1/);
    await page.getByRole('button', { name: 'Reset' }).click();
    assert.ok(Math.abs(km(await text('.total')) - sum(() => true)) < 0.06);
    await close();
  });

  test('shows the same again from its address', async () => {
    const { detail } = lonely();
    const { page, text, close } = await town.page(`#${at(detail, 16)}&s=${detail.segment}&c=good&unit=in/mi&theme=dark&mode=confidence`);
    await page.waitForSelector('.drawer dl');
    assert.equal(await text('.value strong'), (detail.iri * 63.36).toFixed(0));
    assert.equal(await page.getByRole('checkbox', { name: /^Good/ }).isChecked(), false);
    assert.equal(await page.getByRole('radio', { name: 'Confidence' }).isChecked(), true);
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), 'dark');
    await close();
  });

  test('links the worst sections with the map both ways', async () => {
    const { page, text, close } = await town.page();
    const worst = town.query('--worst', '200');
    assert.equal(await page.locator('#worst-table tbody tr').count(), worst.length);
    await page.locator('#worst-1 button').click();
    await page.waitForSelector('.drawer dl');
    await page.waitForFunction(() => Number(/map=([\d.]+)/.exec(location.hash)?.[1]) > 14); // the map went there
    const parts = worst[0].parts.map(({ way_id: way }) => String(way));
    assert.ok(parts.some((way) => page.url().includes(`s=${way}`)), page.url());
    assert.equal(await page.locator('tr[data-picked]').first().getAttribute('id'), 'worst-1');
    assert.ok((await text('.drawer')).length > 0);
    await close();
  });

  test('finds a road by its name', async () => {
    const { page, text, close } = await town.page();
    const road = town.segments.find(({ name }) => name?.length > 5).name;
    await page.keyboard.press('/');
    await page.keyboard.type(road.slice(0, 5).toUpperCase());
    await page.waitForSelector('#found li');
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Enter');
    await page.waitForSelector('.drawer dl');
    assert.ok((await text('.drawer h2')).toLowerCase().startsWith(road.slice(0, 5).toLowerCase()));
    await close();
  });

  test('is walked through by keyboard alone', async () => {
    const { page, text, close } = await town.page();
    await page.keyboard.press('w');
    await page.keyboard.press('Enter');
    await page.waitForSelector('.drawer dl');
    assert.equal(await page.evaluate(() => document.activeElement.id), 'drawer-title');
    const first = await text('.drawer code');
    await page.keyboard.press(']');
    await page.waitForFunction((before) => document.querySelector('.drawer code').textContent !== before, first);
    await page.keyboard.press('Escape');
    assert.equal(await page.locator('.drawer').isVisible(), false);
    assert.equal(await page.evaluate(() => document.activeElement.closest('tr')?.id), 'worst-1', 'the focus is back');
    await close();
  });

  test('mirrors the map in the table of roads in view', async () => {
    const { page, close } = await town.page(`#${at(lonely().detail, 16)}`);
    await page.waitForSelector('#view-table tbody tr');
    const rows = await page.locator('#view-table tbody tr').count();
    assert.ok(rows > 0);
    await page.locator('#view-table button').first().click();
    await page.waitForSelector('.drawer dl');
    await close();
  });

  for (const [zoom, direction] of [[11, 'mean IRI of the rougher direction'], [12.5, 'mean IRI [\\d.]+ mm']]) {
    test(`says of which direction the mean in view is: zoom ${zoom}`, async () => {
      const [west, south, east, north] = town.site.bounds;
      const { page, close } = await town.page(`#map=${zoom}/${(south + north) / 2}/${(west + east) / 2}`);
      await page.waitForFunction((words) => new RegExp(`km, ${words}`).test(document.querySelector('#view').textContent), direction);
      await close();
    });
  }

  for (const how of ['by a key', 'by its address']) {
    test(`compares two months ${how}, and calls only what is beyond chance a change`, async () => {
      const [west, south, east, north] = town.site.bounds;
      const { page, text, close } = await town.page(`#map=15/${(south + north) / 2}/${(west + east) / 2}${how === 'by a key' ? '' : '&mode=change'}`);
      if (how === 'by a key') await page.keyboard.press('c');
      await page.waitForFunction(() => /In view: \d+/.test(document.querySelector('.panel').textContent));
      assert.match(await text('.panel'), /In view: \d+ segments smoother, \d+ rougher, \d+ without significant change/);
      await close();
    });
  }

  test('compares also what is drawn beyond the view, and counts what is in view', async () => {
    const { bounds: [west, south, east, north], compare: { zoom }, months } = town.site;
    const tiles = 2 ** zoom;
    const column = Math.floor(tiles * ((west + east) / 2 + 180) / 360);
    const row = Math.floor(tiles * (1 - Math.asinh(Math.tan((south + north) / 2 * Math.PI / 180)) / Math.PI) / 2);
    assert.ok(tiles * (east + 180) / 360 > column + 1, 'the town goes on to the east');
    // Two zooms further a tile is 2,048 pixels wide. 600 lie to the right: more than half of the view of 960, less than half of the 1,536 that are drawn.
    const lon = (column + 1 - 600 / 2048) / tiles * 360 - 180;
    const lat = Math.atan(Math.sinh(Math.PI * (1 - 2 * (row + 0.5) / tiles))) * 180 / Math.PI;
    const { page, text, close } = await town.page(`#map=${zoom + 2}/${lat}/${lon}&mode=change`);
    const asked = () => page.evaluate(() => performance.getEntriesByType('resource').map(({ name }) => /months\/\d+\/\d+\/\d+/.exec(name)?.[0]).filter(Boolean));
    await page.waitForFunction((sought) => performance.getEntriesByType('resource').some(({ name }) => name.includes(sought)), `months/${zoom}/${column + 1}/`);
    assert.deepEqual([...new Set(await asked())].sort(), [column, column + 1].map((each) => `months/${zoom}/${each}/${row}`));
    await page.waitForFunction(() => /In view: \d+/.test(document.querySelector('.panel').textContent));
    const told = /In view: (\d+) segments smoother, (\d+) rougher, (\d+) without/.exec(await text('.panel')).slice(1);
    const inView = Object.values(JSON.parse(readFileSync(join(town.folder, `site/months/${zoom}/${column}/${row}.json`), 'utf8')))
      .filter((each) => [0, months.length - 1].every((sought) => each.some(([month]) => month === sought)));
    assert.ok(inView.length > 0);
    assert.equal(told.reduce((sum, each) => sum + Number(each), 0), inView.length);
    await close();
  });

  // Some neighbouring measured segments of one way, in driving direction.
  function stretch(count) {
    const names = new Map(details().map((each) => [each.segment, each]));
    for (const first of names.keys()) {
      const [, way, index] = /^(\d+\+)(\d+)$/.exec(first) ?? [];
      const run = way && Array.from({ length: count }, (_, i) => names.get(`${way}${String(Number(index) + i).padStart(4, '0')}`));
      if (run?.every((each) => each && each.to_m - each.from_m > 15)) return run;
    }
    throw new Error(`no way has ${count} measured segments on end`);
  }
  const meanOf = (run, key) => run.reduce((sum, each) => sum + each[key] * (each.to_m - each.from_m), 0) / run.reduce((sum, each) => sum + each.to_m - each.from_m, 0);
  const near = (text, value, within) => assert.ok(Math.abs(Number(text) - value) <= within, `${text} and ${value}`);

  test('shows the profile between two roads that are clicked, and of the part between its ends', async () => {
    const run = stretch(8);
    const [first, last] = [run[0], run.at(-1)];
    const { page, text, breaches, close } = await town.page(`#${at(run[4], 17)}`, { width: 1600 }); // so that the drawer hides neither
    await page.keyboard.press('r');
    await page.waitForSelector('.drawer #drawer-title');
    const [zoom, lat, lon] = /map=([^&]+)/.exec(page.url())[1].split('/').map(Number);
    const box = await page.locator('#map canvas').boundingBox();
    const scale = 512 * 2 ** zoom / 360;
    const click = ({ line }) => {
      const [a, b] = [line[0], line.at(-1)];
      const [x, y] = [(a[0] + b[0]) / 2 - lon, (a[1] + b[1]) / 2 - lat];
      const course = Math.atan2((b[0] - a[0]) * Math.cos(lat * Math.PI / 180), b[1] - a[1]);
      const side = 6.3; // pixels to the right in driving direction at zoom 17
      return page.mouse.click(box.x + box.width / 2 + x * scale + side * Math.cos(course), box.y + box.height / 2 - y * scale / Math.cos(lat * Math.PI / 180) + side * Math.sin(course));
    };
    await click(first);
    await page.waitForFunction(() => document.querySelectorAll('.points li').length === 1);
    await click(last);
    await page.waitForSelector('#profile-part strong');
    near(await text('#profile-part strong'), meanOf(run, 'iri'), 0.02);
    assert.equal(await page.locator('#profile-table tbody tr').count(), run.length);
    assert.equal(await page.locator('.end').count(), 2);
    assert.deepEqual(await breaches(), []);
    await page.locator('#profile-from').focus();
    for (let i = 0; i < 4; ++i) await page.keyboard.press('ArrowRight');
    await page.waitForFunction((count) => document.querySelectorAll('#profile-table tbody tr').length < count, run.length);
    assert.equal(await page.locator('#profile-from').getAttribute('aria-valuetext'), '40 m');
    await page.locator('#profile-part').waitFor();
    await page.keyboard.press('Escape');
    assert.equal(await page.locator('.drawer').isVisible(), false);
    assert.equal(await page.locator('.end').count(), 0);
    await close();
  });

  test('shows the same profile from its address wherever the map is, and goes on from it by keyboard', async () => {
    const run = stretch(8);
    const [first, last] = [run[0].segment, run.at(-1).segment];
    const { page, text, close } = await town.page(`#map=9/48/15&r=${first},${last}&way=${first}~${last}`, { width: 390, height: 700 });
    await page.waitForSelector('#profile-part strong');
    near(await text('#profile-part strong'), meanOf(run, 'iri'), 0.006);
    const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Profile as CSV' }).click()]);
    assert.equal(readFileSync(await file.path(), 'utf8').trim().split('\n').length - 1, run.length);
    await page.getByText('As a table').click();
    await page.locator('#profile-table button').nth(3).click();
    await page.waitForSelector('.drawer code');
    await page.getByRole('button', { name: 'Profile to here' }).click();
    await page.waitForFunction(() => document.querySelectorAll('.points li').length === 3);
    assert.match(await text('.drawer'), /No way over measured roads is known/, 'the road is one way, or was not measured back');
    await page.getByRole('button', { name: /^Remove point/ }).last().click();
    await page.waitForSelector('#profile-part strong');
    await close();
  });

  test('swipes between two months by keyboard, and breaks no rule there', async () => {
    const [west, south, east, north] = town.site.bounds;
    const { page, breaches, close } = await town.page(`#map=15/${(south + north) / 2}/${(west + east) / 2}&mode=change`);
    await page.getByRole('checkbox', { name: 'Swipe between the months' }).check();
    await page.waitForFunction(() => document.querySelectorAll('#map canvas').length === 2);
    const uncovered = () => page.evaluate(() => document.querySelector('.swipe-line').getBoundingClientRect().left);
    const middle = await uncovered();
    await page.locator('.swipe').focus();
    for (let i = 0; i < 10; ++i) await page.keyboard.press('ArrowRight');
    assert.ok(await uncovered() > middle + 50);
    assert.match(await page.locator('.swipe').getAttribute('aria-valuetext'), /60 %.* 40 %/);
    assert.deepEqual(await breaches(), []);
    await page.getByRole('radio', { name: 'Roughness' }).check();
    await page.waitForFunction(() => document.querySelectorAll('#map canvas').length === 1);
    await close();
  });

  test('says what acts only from closer up', async () => {
    const { page, text, close } = await town.page('#map=12/48.4/15.6&mode=change&q=1');
    await page.waitForFunction(() => /from closer up/.test(document.querySelector('#legend').textContent));
    assert.match(await text('#legend'), /Seen from afar; zoom in to compare/);
    assert.doesNotMatch(await text('#legend'), /Not measured in both months/);
    await close();
  });

  test('hands on the filtered segments as CSV and GeoJSON, and says their number first', async () => {
    const { page, text, close } = await town.page('#c=poor');
    const asked = town.segments.filter(({ class: name }) => name !== 'poor').length;
    const told = Number(/about (\d+) segments/.exec(await text('#export'))[1]);
    assert.ok(Math.abs(told - asked) < 0.1 * asked, `${told} and ${asked}: from the kilometres`);
    const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Download CSV' }).click()]);
    const lines = readFileSync(await file.path(), 'utf8').trim().split('\n');
    assert.equal(lines.length - 1, asked);
    assert.match(lines[0], /^segment,way_id,name,/);
    const [second] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Download GeoJSON' }).click()]);
    const { features } = JSON.parse(readFileSync(await second.path(), 'utf8'));
    assert.deepEqual(features.map(({ properties, geometry }) => [properties.segment, properties.iri, geometry.coordinates]),
      details().filter(({ class: name }) => name !== 'poor').map(({ segment, iri, line }) => [segment, iri, line]));
    await close();
  });

  test('speaks German with the words of the report', async () => {
    const { page, text, close } = await town.page('#lang=de');
    assert.match(await text('.panel'), /Schlecht \(über 2,68\)/);
    assert.equal(await page.evaluate(() => document.documentElement.lang), 'de');
    assert.doesNotMatch(await text('body'), /site\./);
    await close();
  });

  for (const theme of ['light', 'dark', 'contrast']) {
    test(`breaks no rule of axe-core in the theme ${theme}, with drawer and without`, async () => {
      const { page, breaches, close } = await town.page(`#theme=${theme}&lang=de`);
      await page.locator('.settings summary').click();
      assert.deepEqual(await breaches(), []);
      await page.locator('#worst-2 button').click();
      await page.waitForSelector('.drawer dl');
      assert.deepEqual(await breaches(), []);
      await close();
    });
  }

  for (const width of [320, 768]) {
    test(`fits ${width} pixels without scrolling sideways, and breaks no rule there`, async () => {
      const { page, breaches, close } = await town.page('', { width, height: 640, hasTouch: true });
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
      await page.locator('.settings summary').click();
      await page.locator('.settings summary').click();
      if (width === 320) await page.locator('.handle').click();
      assert.deepEqual(await breaches(), []);
      await close();
    });
  }

  test('shows names with markup as text, and leads to the recorder', async () => {
    const { page, text, close } = await town.page();
    assert.equal(await text('h1'), 'Krems <b>&amp;');
    assert.equal(await page.locator('h1 b').count(), 0);
    await page.getByRole('link', { name: 'Record a trip' }).click();
    await page.waitForSelector('#page > *'); // the recorder
    await close();
  });

  test('says that no road passes a filter, and leads back to the data', async () => {
    const { page, text, close } = await town.page('#p=10&q=0&c=good,fair,poor');
    await page.waitForFunction(() => document.querySelector('#view').textContent.includes('No measured road'));
    await page.getByRole('button', { name: 'Show all roads' }).click();
    await page.waitForSelector('#view-table tbody tr');
    assert.match(await text('.total'), /shown/);
    await close();
  });

  test('shows all roads as a picture where the map will draw them, until it has', async () => {
    let release;
    const held = new Promise((resolve) => { release = resolve; });
    const opened = await town.page('', { ready: false, before: (page) => page.route('**/maplibre-gl.mjs', async (route) => { await held; await route.continue(); }) });
    await opened.page.waitForFunction(() => document.querySelector('img.first-picture')?.naturalWidth > 0);
    const { image, map, bounds } = await opened.page.evaluate(async () => {
      const box = (query) => { const { left, top, width, height } = document.querySelector(query).getBoundingClientRect(); return { left, top, width, height }; };
      return { image: box('img.first-picture'), map: box('#map'), bounds: (await (await fetch('site.json')).json()).first_picture };
    });
    release();
    await opened.page.waitForSelector('#map[data-ready]');
    await opened.page.waitForSelector('img.first-picture', { state: 'detached' });
    // The map tells its view when it has moved: there and back.
    await opened.page.locator('#map canvas').focus();
    await opened.page.keyboard.press('=');
    await opened.page.waitForFunction(() => location.hash.includes('map='));
    const nearer = await opened.page.evaluate(() => location.hash);
    await opened.page.keyboard.press('-');
    await opened.page.waitForFunction((before) => location.hash !== before, nearer);
    const [zoom, lat, lon] = (await opened.page.evaluate(() => location.hash)).match(/map=([^&]*)/)?.[1].split('/').map(Number) ?? [];
    const world = 512 * 2 ** zoom;
    const y = (deg) => 0.5 - Math.log(Math.tan(Math.PI / 4 + deg * Math.PI / 360)) / (2 * Math.PI);
    const at = ([east, north]) => [map.left + map.width / 2 + world * (east - lon) / 360, map.top + map.height / 2 + world * (y(north) - y(lat))];
    const [left, top] = at([bounds[0], bounds[3]]);
    const [right, bottom] = at([bounds[2], bounds[1]]);
    for (const [seen, expected] of [[image.left, left], [image.top, top], [image.left + image.width, right], [image.top + image.height, bottom]]) {
      assert.ok(Math.abs(seen - expected) < 4, `${seen} px, expected ${expected} px`); // zoom is told to 0.01: 0.7 %
    }
    await opened.close();
  });

  test('has all values in lists without WebGL', async () => {
    const opened = await town.page('', { ready: false, before: (page) => page.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; }) });
    await opened.page.waitForSelector('#road-table tbody tr');
    assert.match(await opened.text('#map'), /WebGL 2 is missing/);
    await opened.page.waitForFunction(() => document.querySelector('img.overview')?.naturalWidth === 1200);
    await opened.page.locator('#road-table button').first().click();
    await opened.page.waitForSelector('.drawer dl');
    assert.deepEqual(await opened.breaches(), []);
    await opened.close();
  });

  test('pans picture tiles of a server without WebGL', async () => {
    const live = await served(town.database);
    await live.waitFor('/site.json');
    const opened = await town.page('/', { url: live.url, ready: false, before: (page) => page.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; }) });
    const { page } = opened;
    const shown = () => page.evaluate(() => [...document.querySelectorAll('.tiles img')].filter((tile) => !tile.hidden && tile.naturalWidth === 256).map((tile) => tile.style.transform).sort().join());
    const changed = async (act) => {
      const before = await shown();
      await act();
      await page.waitForFunction((then) => {
        const now = [...document.querySelectorAll('.tiles img')].filter((tile) => !tile.hidden && tile.naturalWidth === 256).map((tile) => tile.style.transform).sort().join();
        return now !== '' && now !== then;
      }, before);
    };
    await changed(() => page.waitForSelector('.tiles img:not([hidden])', { state: 'attached' }));
    await page.locator('.pictures').focus();
    await changed(() => page.keyboard.press('ArrowRight'));
    await changed(() => page.getByRole('button', { name: 'Zoom in' }).click());
    assert.deepEqual(await opened.breaches(), []);
    await opened.close();
    live.close();
  });

  test('says what failed, and tries again', async () => {
    const { detail } = lonely();
    let isBroken = true;
    const opened = await town.page(`#s=${detail.segment}`, { before: (page) => page.route('**/segments/*.json', (route) => (isBroken ? route.fulfill({ status: 500 }) : route.continue())) });
    await opened.page.waitForSelector('.notice[role=alert] button');
    assert.match(await opened.text('.notice'), /segments\/\w+\.json: 500/);
    isBroken = false;
    await opened.page.locator('.notice button').click();
    await opened.page.waitForSelector('.drawer dl');
    opened.wrong.splice(0); // the browser's own words on the failure
    await opened.close();
  });

  test('says that there is no network', async () => {
    const { page, text, close } = await town.page();
    await page.context().setOffline(true);
    await page.waitForSelector('.notice[role=alert]:not([hidden])');
    assert.match(await text('.notice'), /No network[^]*Data up to \d{4}-\d\d-\d\d/);
    await page.context().setOffline(false);
    await close();
  });

  test('opens without a network with what was seen, and keeps nothing of an older version', async () => {
    const { page, drawn, text, wrong, close } = await town.page(`#${at(lonely().detail, 15)}`, { keeps: true });
    const again = async () => { await page.reload(); await drawn(); };
    const keptUrls = () => page.evaluate(async () => (await Promise.all((await caches.keys()).map(async (name) => (await (await caches.open(name)).keys()).map(({ url }) => url)))).flat());
    const untilKept = async (isSo) => { // Playwright's waitForFunction takes a promise for yes
      while (!isSo(await keptUrls())) await page.waitForTimeout(50); // the test's time limit ends it
    };
    const place = () => /map=[^&]*/.exec(page.url())?.[0];
    await page.waitForFunction(() => navigator.serviceWorker.controller);
    await again();
    const before = place();
    await page.locator('#worst-1 button').click();
    await page.waitForSelector('.drawer dl');
    await page.waitForFunction((left) => /map=[^&]*/.exec(location.hash)?.[0] !== left, before); // the map went there
    await drawn();
    await untilKept((urls) => [/segments\/\d+\.json/, /roads\.pmtiles\?part=/].every((kind) => urls.some((url) => kind.test(url))));
    await page.context().setOffline(true);
    await again();
    await page.waitForSelector('.drawer dl');
    await page.waitForFunction(() => /No network/.test(document.querySelector('.notice').textContent));
    await page.waitForSelector('#view-table tbody tr');
    assert.ok((await keptUrls()).some((url) => /roads\.pmtiles\?part=/.test(url)));
    wrong.splice(0); // the browser's own words on the failures
    await page.context().setOffline(false);
    const file = join(town.folder, 'site/site.json');
    const content = readFileSync(file, 'utf8');
    try {
      writeFileSync(file, content.replace('"digest":"', '"digest":"0'));
      await page.goto(town.server.url);
      await drawn();
      await untilKept((urls) => !urls.some((url) => /segments\/\d+\.json/.test(url)));
    } finally {
      writeFileSync(file, content);
    }
    assert.equal(await text('h1'), 'Krems <b>&amp;');
    await close();
  });

  test('says which months could not be loaded, and compares when they can', async () => {
    const [west, south, east, north] = town.site.bounds;
    let isBroken = true;
    const { page, text, wrong, close } = await town.page(`#map=15/${(south + north) / 2}/${(west + east) / 2}&mode=change`, { before: (page) => page.route('**/months/**', (route) => (isBroken ? route.fulfill({ status: 500 }) : route.continue())) });
    await page.waitForSelector('.notice[role=alert] button');
    assert.match(await text('.notice'), /months\/.*: 500/);
    isBroken = false;
    await page.locator('.notice button').click();
    await page.waitForFunction(() => /In view: \d+/.test(document.querySelector('.panel').textContent));
    wrong.splice(0); // the browser's own words on the failures
    await close();
  });

  test('keeps its map where a segment of a link to a route cannot be loaded', async () => {
    const run = stretch(8);
    const [first, last] = [run[0].segment, run.at(-1).segment];
    let isBroken = true;
    const { page, wrong, close } = await town.page(`#r=${first},${last}&way=${first}~${last}`, { before: (page) => page.route('**/segments/*.json', (route) => (isBroken ? route.fulfill({ status: 500 }) : route.continue())) });
    await page.waitForSelector('.notice[role=alert] button');
    assert.equal(await page.locator('#map canvas').count(), 1);
    isBroken = false;
    await page.locator('.notice button').click();
    await page.waitForSelector('#profile-part strong');
    wrong.splice(0); // the browser's own words on the failures
    await close();
  });

  test('goes on along a road from way to way, and says where it ends', async () => {
    const all = details();
    const ids = new Set(all.map(({ segment }) => segment));
    const network = newNetwork();
    addFeatures(network, all.map(({ line, months, ...properties }) => ({ properties, geometry: { type: 'LineString', coordinates: line } })));
    const isLast = ({ segment, name }) => { const { way, backward, index } = parseId(segment); return name && !backward && !ids.has(`${way}+${String(index + 1).padStart(4, '0')}`); };
    const lasts = all.filter(isLast);
    const before = lasts.find((each) => continuation(network, each, 1));
    const end = lasts.find((each) => network.segments.has(each.segment) && network.from[network.segments.get(each.segment).end].every(({ name }) => name !== each.name));
    const { page, text, breaches, close } = await town.page(`#${at(before, 17)}&s=${before.segment}`, { width: 1600 });
    await page.waitForSelector('.drawer dl');
    await page.keyboard.press(']');
    await page.waitForFunction((id) => document.querySelector('.drawer code').textContent !== id, before.segment);
    assert.equal(await text('.drawer code'), continuation(network, before, 1));
    await page.keyboard.press('[');
    await page.waitForFunction((id) => document.querySelector('.drawer code').textContent === id, before.segment);
    assert.equal(await text('.status'), '');
    await page.goto(`${page.url().split('#')[0]}#${at(end, 17)}&s=${end.segment}`);
    await page.waitForFunction((id) => document.querySelector('.drawer code')?.textContent === id, end.segment);
    await page.keyboard.press(']');
    await page.waitForFunction(() => /End of the road/.test(document.querySelector('.status[role=status]').textContent));
    assert.deepEqual(await breaches(), []);
    await page.keyboard.press('Escape');
    assert.equal(await text('.status'), '');
    await close();
  });

  for (const source of ['a folder', 'a server']) {
    test(`says that ${source} has no segment of a link or a search`, async () => {
      const asOfServer = { ...town.site, segments: { url: 'segments/{id}.json' } };
      const { page, wrong, close } = await town.page('#s=999%2B0000', { before: (page) => page.route('**/site.json', (route) => (source === 'a server' ? route.fulfill({ json: asOfServer }) : route.continue())) });
      const says = (words) => page.waitForFunction((sought) => document.querySelector('.status[role=status]').textContent.includes(sought), words);
      await says('Segment 999+0000 is not in this map');
      await page.keyboard.press('/');
      await page.keyboard.type('998+0001');
      await page.waitForSelector('#found li');
      await page.keyboard.press('Enter');
      await says('Segment 998+0001 is not in this map');
      await page.locator('#search').fill('Nowhere at all');
      await page.waitForFunction(() => /No measured road/.test(document.querySelector('#found').textContent));
      await page.keyboard.press('Enter');
      await says('No measured road of this name');
      assert.equal(await page.locator('.notice').isVisible(), false);
      if (source === 'a server') wrong.splice(0); // the browser's own words on 404
      await close();
    });
  }

  test('says how many roads in view its table leaves out', async () => {
    const { fromGeojsonVt } = await import('@maplibre/vt-pbf');
    const [west, south, east, north] = town.site.bounds;
    const tiles = 2 ** 14;
    const column = Math.floor(tiles * ((west + east) / 2 + 180) / 360);
    const row = Math.floor(tiles * (1 - Math.asinh(Math.tan((south + north) / 2 * Math.PI / 180)) / Math.PI) / 2);
    const features = Array.from({ length: 63 }, (_, i) => ({ type: 2, geometry: [[[100, 60 * (i + 1)], [3900, 60 * (i + 1)]]],
      tags: { segment: `${i + 1}+0000`, way_id: i + 1, direction: 'forward', name: `Road ${i}`, highway: 'residential', from_m: 0, to_m: 20, iri: 1, iri_low: 0.9, iri_high: 1.1, class: i === 0 ? 'poor' : 'good', passes: i < 12 ? 1 : 2 } }));
    const body = Buffer.from(fromGeojsonVt({ roughness: { features } }, { version: 2, extent: 4096 }));
    const lon = (column + 0.5) / tiles * 360 - 180;
    const lat = Math.atan(Math.sinh(Math.PI * (1 - 2 * (row + 0.5) / tiles))) * 180 / Math.PI;
    const { page, text, close } = await town.page(`#map=14/${lat}/${lon}`, { before: async (page) => {
      await page.route('**/site.json', (route) => route.fulfill({ json: { ...town.site, tiles: { url: 'tiles/{z}/{x}/{y}.pbf', min_zoom: 14, max_zoom: 14 } } }));
      await page.route('**/tiles/14/**', (route) => (route.request().url().endsWith(`/${column}/${row}.pbf`) ? route.fulfill({ body }) : route.fulfill({ status: 204 })));
    } });
    await page.waitForFunction(() => document.querySelectorAll('#view-table tbody tr').length === 50);
    assert.match(await text('#view'), /13 more roads; zoom in or filter/);
    await page.getByLabel('Passes, at least').selectOption('2');
    await page.waitForFunction(() => [...document.querySelectorAll('#view p')].at(-1).textContent === '1 more road; zoom in or filter');
    await page.getByLabel('Passes, at least').selectOption('5');
    await page.waitForFunction(() => /No measured road/.test(document.querySelector('#view').textContent));
    await close();
  });

  test('says without WebGL that its table has the first roads alone', async () => {
    const names = Array.from({ length: 250 }, (_, i) => ({ name: `Road ${i}`, key: `road ${String(i).padStart(3, '0')}`, km: 1, iri: 1, bounds: town.site.bounds, segment: '1+0000' }));
    const { page, text, close } = await town.page('', { ready: false, before: async (page) => {
      await page.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; });
      await page.route('**/names/index.json', (route) => route.fulfill({ json: [names[0].key] }));
      await page.route('**/names/0.json', (route) => route.fulfill({ json: names }));
    } });
    await page.waitForFunction(() => document.querySelectorAll('#road-table tbody tr').length === 200);
    assert.match(await text('#map'), /The first 200 roads by name; the search finds all/);
    await close();
  });

  for (const [width, height] of [[320, 640], [568, 320], [768, 900], [1440, 900]]) {
    test(`names its source, and says that it is indicative, in ${width} x ${height} pixels`, async () => {
      const { page, breaches, close } = await town.page('', { width, height, hasTouch: width < 700 });
      for (const words of [town.site.attribution, 'Indicative; no substitute for a survey']) {
        const box = await page.locator('footer').getByText(words).boundingBox();
        assert.ok(box && box.height > 0 && box.x >= 0 && box.x + box.width <= width && box.y + box.height <= height, words);
      }
      assert.deepEqual(await breaches(), []);
      await close();
    });
  }

  test('breaks no rule in forced colours and high contrast in 320 pixels', async () => {
    const { page, breaches, close } = await town.page('', { width: 320, height: 640, forcedColors: 'active', contrast: 'more', hasTouch: true });
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    assert.deepEqual(await breaches(), []);
    await page.keyboard.press('w');
    await page.keyboard.press('Enter');
    await page.waitForSelector('.drawer dl');
    assert.deepEqual(await breaches(), []);
    await close();
  });

  test('serves a whole session by keyboard: search, filter, export, settings', async () => {
    const { page, text, close } = await town.page();
    const press = async (...keys) => { for (const key of keys) await page.keyboard.press(key); };
    const focused = (property = 'textContent') => page.evaluate((name) => document.activeElement[name], property);
    const tabTo = async (words, key = 'Tab') => { // the text of a control, or of its label
      for (let i = 0; i < 60; ++i) {
        await press(key);
        if (await page.evaluate((sought) => (document.activeElement.closest('label') ?? document.activeElement).textContent.startsWith(sought) && document.activeElement !== document.body, words)) return;
      }
      assert.fail(`no key leads to ${words}`);
    };
    await press('/');
    await page.keyboard.type(town.segments.find(({ name }) => name?.length > 5).name.slice(0, 3));
    await page.waitForSelector('#found li[id]');
    await press('ArrowDown');
    assert.equal(await page.locator('#search').getAttribute('aria-activedescendant'), 'found-0');
    const chosen = (await text('#found-0')).split(' ')[0];
    await press('Enter');
    await page.waitForSelector('.drawer dl');
    assert.equal(await focused('id'), 'drawer-title');
    assert.ok((await focused()).startsWith(chosen));
    await tabTo('Onward');
    const first = await text('.drawer code');
    await press('Enter');
    await page.waitForFunction((id) => document.querySelector('.drawer code').textContent !== id || document.querySelector('.status').textContent !== '', first);
    assert.match(await focused(), /^Onward/);
    await press('Escape');
    assert.equal(await focused('id'), 'search', 'the focus is back');

    await tabTo('Settings');
    await press('Enter');
    await tabTo('Unit');
    await press('i'); // of in/mi
    await page.waitForFunction(() => document.querySelector('.settings')?.open && document.activeElement.name === 'unit' && / mi of /.test(document.querySelector('.total')?.textContent));
    await press('m');
    await page.waitForFunction(() => document.querySelector('.settings')?.open && document.activeElement.name === 'unit' && / km of /.test(document.querySelector('.total')?.textContent));
    await press('Escape');
    assert.equal(await page.locator('.menu').isVisible(), false);
    assert.equal(await focused(), 'Settings', 'the focus is back');

    await tabTo('Poor');
    const all = await text('.total');
    await press('Space');
    await page.waitForFunction((before) => document.querySelector('.total').textContent !== before, all);
    assert.match(page.url(), /c=poor/);
    assert.match(await page.evaluate(() => document.activeElement.closest('label').textContent), /^Poor/);

    await tabTo('Download CSV', 'Shift+Tab'); // the shorter way round
    const [file] = await Promise.all([page.waitForEvent('download'), press('Enter')]);
    assert.equal(readFileSync(await file.path(), 'utf8').trim().split('\n').length - 1, town.segments.filter(({ class: name }) => name !== 'poor').length);
    await page.waitForFunction(() => document.activeElement.textContent === 'Download CSV');
    assert.equal(await page.evaluate(() => document.scrollingElement.scrollTop), 0, 'the head stays in sight');
    await close();
  });

  test('draws the same again after the browser took its graphics context', { timeout: 200_000 }, async () => {
    const [west, south, east, north] = town.site.bounds;
    const { page, drawn, close } = await town.page(`#map=15/${(south + north) / 2}/${(west + east) / 2}&mode=change`);
    await page.waitForFunction(() => /In view: \d+/.test(document.querySelector('.panel').textContent));
    const context = (what) => page.evaluate((act) => {
      globalThis.taking ??= document.querySelector('#map canvas').getContext('webgl2').getExtension('WEBGL_lose_context');
      globalThis.taking[act]();
    }, what);
    // The picture when nothing changes it any more.
    const settled = async (isWanted) => {
      for (let before = null; ;) { // the test's time limit ends it
        await drawn();
        const now = await page.locator('#map').screenshot();
        if (before?.equals(now) && isWanted(now)) return now;
        before = now;
      }
    };
    const before = await settled(() => true);
    await context('loseContext');
    await settled((now) => !now.equals(before));
    await context('restoreContext');
    await settled((now) => now.equals(before));
    await close();
  });

  for (const scale of [1, 2]) {
    test(`finds what it draws after wheel and pinch, with ${scale} pixels of the screen for one of the page`, async () => {
      const { detail } = lonely();
      const { page, text, close } = await town.page(`#${at(detail)}`, { deviceScaleFactor: scale, hasTouch: true });
      const box = await page.locator('#map').boundingBox();
      const [x, y] = [box.x + box.width / 2, box.y + box.height / 2].map(Math.round);
      const place = () => /map=([^&]+)/.exec(page.url())[1].split('/').map(Number);
      const zoomed = (from) => page.waitForFunction((zoom) => Math.abs(Number(/map=([\d.]+)/.exec(location.hash)[1]) - zoom) > 0.1 && document.querySelector('#map[data-ready] canvas')?.style.transform === '', from);
      await page.mouse.move(x, y);
      await page.mouse.wheel(0, 240);
      await zoomed(18);
      const [wheeled] = place();
      assert.ok(wheeled < 18);
      const session = await page.context().newCDPSession(page);
      await session.send('Input.synthesizePinchGesture', { x, y, scaleFactor: 1.5, relativeSpeed: 400, gestureSourceType: 'touch' });
      await zoomed(wheeled);
      const [zoom, lat, lon] = place();
      assert.ok(zoom > wheeled);
      const [[lon1, lat1], [lon2, lat2]] = [detail.line[0], detail.line.at(-1)];
      const east = Math.cos(lat * Math.PI / 180);
      const world = 512 * 2 ** zoom / 360; // pixels for a degree of longitude
      const course = Math.atan2((lon2 - lon1) * east, lat2 - lat1);
      const side = 4.5 + 5.5 * (zoom - 16) / 3; // pixels to the right in driving direction, as map.js has it
      await page.mouse.click(box.x + box.width / 2 + ((lon1 + lon2) / 2 - lon) * world + side * Math.cos(course), box.y + box.height / 2 - ((lat1 + lat2) / 2 - lat) * world / east + side * Math.sin(course));
      await page.waitForSelector('.drawer dl');
      assert.equal(await text('.drawer code'), detail.segment);
      await close();
    });
  }

  test('leads to the data without script', async () => {
    const { page, close } = await town.page('', { ready: false, javaScriptEnabled: false });
    assert.match(await page.locator('noscript').innerText(), /roughest sections/);
    await close();
  });
});
