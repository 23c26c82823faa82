#include "render/report/document/page_script.hpp"

namespace macadam {

std::string_view page_script() {
    return R"(
'use strict';
const { csv, sort, mark } = document.body.dataset;
const all = (selector, of = document) => [...of.querySelectorAll(selector)];
const words = (cell) => (cell.querySelector('svg.share') || cell).ariaLabel || cell.innerText.trim();

// Sections are folded on phones, but not those that a link leads to, and none on paper.
const sections = all('main details');
const unfold = () => {
  const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  const section = target && target.closest('details');
  if (section && !section.open) { section.open = true; target.scrollIntoView(); }
};
if (matchMedia('(max-width:44rem)').matches) sections.slice(1).forEach((section) => { section.open = false; });
addEventListener('hashchange', unfold);
addEventListener('beforeprint', () => sections.forEach((section) => { section.open = true; }));
unfold();

// Numbers as people write them: thousands parted by blanks, a sign of any kind, a decimal mark.
function number(text) {
  const found = text.replace(/[\s\u202f\u00a0]/g, '').replace('\u2212', '-').replace(mark, '.').match(/^[^\d+-]*([+-]?\d+(\.\d+)?)/);
  return found ? Number(found[1]) : NaN;
}
const key = (row, i) => words(row.cells[i]);

function sortBy(table, heading, i) {
  const down = heading.ariaSort !== 'descending';
  const body = table.tBodies[0];
  const rows = all('tr:not(.all)', body);
  const numeric = heading.classList.contains('n');
  const compare = (a, b) => {
    const [x, y] = [key(a, i), key(b, i)];
    if (!numeric) return y.localeCompare(x, document.documentElement.lang, { numeric: true });
    const [p, q] = [number(x), number(y)];
    return Number.isNaN(p) - Number.isNaN(q) || (Number.isNaN(p) ? 0 : p - q);
  };
  rows.sort((a, b) => (down ? -compare(a, b) : compare(a, b)));
  all('th', table.tHead).forEach((th) => th.removeAttribute('aria-sort'));
  heading.ariaSort = down ? 'descending' : 'ascending';
  body.prepend(...rows);
}

function csvOf(table) {
  const field = (text) => (/[",;\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const plain = (text) => {
    const bare = text.replace(/[\s\u202f\u00a0]/g, '').replace('\u2212', '-').replace(mark, '.');
    return /^[+-]?\d+(\.\d+)?$/.test(bare) ? bare : text.replaceAll('\n', '; ');
  };
  return all('tr', table).map((row) => [...row.cells].map((cell) => {
    const text = plain(words(cell));
    return field(/^[=@\t\r]/.test(text) ? `'${text}` : text); // no formula of a spreadsheet
  }).join(',')).join('\r\n');
}

all('.wide table').forEach((table, n) => {
  const headings = all('th', table.tHead);
  if (table.tBodies[0].rows.length > 2) headings.forEach((heading, i) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.append(...heading.childNodes);
    button.title = sort.replace('{column}', button.textContent);
    button.onclick = () => sortBy(table, heading, i);
    heading.append(button);
  });
  const save = document.createElement('button');
  save.type = 'button';
  save.className = 'save';
  save.textContent = csv;
  save.ariaLabel = `${csv}: ${table.caption.innerText}`;
  save.onclick = () => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob(['\ufeff', csvOf(table)], { type: 'text/csv' }));
    link.download = `table-${n + 1}.csv`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };
  table.parentElement.after(save);
});
)";
}

} // namespace macadam
