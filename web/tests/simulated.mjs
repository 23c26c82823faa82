// A database of a small simulated fleet. `node simulated.mjs FOLDER` makes it for several tests, which MACADAM_WEB_DATABASE tells of it.
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readdirSync, rmSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const source = join(dirname(fileURLToPath(import.meta.url)), '../..');

export const macadam = (...words) => execFileSync(process.env.MACADAM_PROGRAM, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1e8 });

// A database in `folder`, of one's own to change.
export function databaseIn(folder) {
  const database = join(folder, 'roads.gpkg');
  const made = process.env.MACADAM_WEB_DATABASE;
  if (!made) simulate(folder, database);
  else for (const name of readdirSync(dirname(made)).filter((each) => each.startsWith(basename(made)))) copyFileSync(join(dirname(made), name), join(folder, name.replace(basename(made), 'roads.gpkg')));
  return database;
}

function simulate(folder, database) {
  const fleet = join(source, 'sample_data/fleet');
  macadam('simulate', '-o', `${folder}/fleet`, '--network', `${fleet}/network.osm.pbf`, '--recipe', `${fleet}/recipe.toml`, '--trips', '4');
  macadam('init', database, '--network', `${folder}/fleet/network.osm.pbf`);
  macadam('import', database, `${folder}/fleet/trips`);
}

const [script, folder] = process.argv.slice(1);
if (script === fileURLToPath(import.meta.url)) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  simulate(folder, join(folder, 'roads.gpkg'));
}
