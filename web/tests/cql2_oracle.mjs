// CQL2 as another program reads and evaluates it (cql2-rs, compiled to WebAssembly), and the standard's JSON schema, which is part of that program.
import Ajv2020 from 'ajv/dist/2020.js';
import * as bindings from 'cql2-wasm/cql2_wasm_bg.js';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const bytes = readFileSync(createRequire(import.meta.url).resolve('cql2-wasm/cql2_wasm_bg.wasm'));
const { exports } = new WebAssembly.Instance(new WebAssembly.Module(bytes), { './cql2_wasm_bg.js': bindings });
bindings.__wbg_set_wasm(exports);
exports.__wbindgen_start();

function schemaIn(text) {
  const begin = text.lastIndexOf('{', text.indexOf('"$dynamicAnchor": "cql2expression"'));
  let depth = 0;
  let end = begin;
  do depth += { '{': 1, '}': -1 }[text[end]] ?? 0; while (end++, depth > 0);
  return JSON.parse(text.slice(begin, end));
}

// Whether JSON is a filter by the standard's schema.
export const fitsSchema = new Ajv2020({ strict: false }).compile(schemaIn(bytes.toString('latin1')));

const ofStandard = { t_finishedby: 't_finishedBy', t_metby: 't_metBy', t_overlappedby: 't_overlappedBy', t_startedby: 't_startedBy' };

// The standard's forms of what cql2-rs writes in its own: boxes, lists of one value, numbers with a minus and some names.
function standardForm(value) {
  if (Array.isArray(value)) return value.map(standardForm);
  if (value === null || typeof value !== 'object') return value;
  const { op, args } = value;
  if (op === 'bbox') return { bbox: args.map(standardForm) };
  if (op === 'in' && !Array.isArray(args[1])) return { op, args: [standardForm(args[0]), [standardForm(args[1])]] };
  if (op === '*' && args[0] === -1 && typeof args[1] === 'number') return -args[1];
  return Object.fromEntries(Object.entries(value).map(([name, each]) => [name, name === 'op' ? ofStandard[each] ?? each : standardForm(each)]));
}

// A filter in JSON for one in text.
export const jsonOf = (text) => standardForm(JSON.parse(bindings.parseText(text).to_json()));

// Tells of a feature whether it passes a filter; undefined if cql2-rs cannot say, as for values that are unknown.
export function evaluator(json) {
  const filter = bindings.parseJson(JSON.stringify(json));
  return ({ geometry, properties }) => {
    try {
      return filter.matches({ type: 'Feature', geometry, properties: Object.fromEntries(Object.entries(properties).filter(([, value]) => value !== null)) });
    } catch {
      return undefined;
    }
  };
}
