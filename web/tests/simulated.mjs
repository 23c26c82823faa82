// A database of a small simulated fleet.
import { execFileSync } from 'node:child_process';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const source = join(dirname(fileURLToPath(import.meta.url)), '../..');

export const macadam = (...words) => execFileSync(process.env.MACADAM_PROGRAM, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1e8 });

export function simulated(folder) {
  const fleet = join(source, 'sample_data/fleet');
  const database = join(folder, 'roads.gpkg');
  macadam('simulate', '-o', `${folder}/fleet`, '--network', `${fleet}/network.osm.pbf`, '--recipe', `${fleet}/recipe.toml`, '--trips', '4');
  macadam('init', database, '--network', `${folder}/fleet/network.osm.pbf`);
  macadam('import', database, `${folder}/fleet/trips`);
  return database;
}
