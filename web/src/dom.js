// Elements by name, attributes and children. No markup is ever parsed, so that names from data stay text.
const svgNames = new Set(['svg', 'g', 'rect', 'path', 'line', 'circle', 'text', 'title']);

export function el(name, attributes = {}, ...children) {
  const node = svgNames.has(name) ? document.createElementNS('http://www.w3.org/2000/svg', name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
    else if (key in node && !svgNames.has(name) && typeof value !== 'string') node[key] = value;
    else node.setAttribute(key, value === true ? '' : value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return node;
}

export const replace = (node, ...children) => { node.replaceChildren(...children.flat().filter(Boolean)); };

export function option(value, text, chosen) {
  return el('option', { value, selected: value === chosen }, text);
}

// Hands text to the reader as a file.
export function download(name, type, parts) {
  const url = URL.createObjectURL(new Blob(parts, { type }));
  el('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
