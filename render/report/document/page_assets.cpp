#include "render/report/document/page_assets.hpp"

#include "render/scene/colour.hpp"

#include <fmt/format.h>

#include <string_view>

namespace macadam {
namespace {

std::string colours_of(MapStyle::Theme theme) {
    const auto colours = palette(theme);
    return fmt::format("--page:#{:06x};--ground:#{:06x};--rule:#{:06x};--ink:#{:06x};"
                       "--quiet:#{:06x};--edge:#{:06x}",
                       colours.page,
                       colours.ground,
                       colours.border,
                       colours.ink,
                       colours.quiet_ink,
                       colours.casing);
}

constexpr const char* rules = R"(
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%;text-size-adjust:100%}
body{margin:0 auto;max-width:64rem;padding:1.25rem 1rem 3rem;background:var(--page);color:var(--ink);
font:1rem/1.55 system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif}
h1{font-size:clamp(1.6rem,1.2rem + 2vw,2.3rem);line-height:1.15;margin:0 0 .4rem;overflow-wrap:anywhere}
h2{font-size:1.3rem;line-height:1.25;margin:2.6rem 0 .6rem;padding-top:1.1rem;border-top:1px solid var(--rule)}
h3{font-size:1rem;line-height:1.3;margin:0;overflow-wrap:anywhere}
p,ul{max-width:44rem;margin:.6rem 0}
ul{padding-left:1.2rem}
li{margin:.25rem 0}
.quiet,caption,figcaption,dt{color:var(--quiet)}
.small{font-size:.875rem}
.key{display:grid;grid-template-columns:repeat(auto-fit,minmax(9.5rem,1fr));gap:.75rem;margin:1.2rem 0}
.key div{background:var(--ground);border:1px solid var(--rule);border-radius:.5rem;padding:.7rem .85rem}
.key dt{font-size:.8125rem;line-height:1.3}
.key dd{margin:.15rem 0 0}
.key b{display:block;white-space:nowrap;font-size:1.35rem;line-height:1.2;font-weight:650;font-variant-numeric:tabular-nums}
.key dd>span{display:block;font-size:.8125rem;line-height:1.35;color:var(--quiet);font-variant-numeric:tabular-nums}
.wide{overflow-x:auto;margin:1rem 0}
.wide:focus-visible{outline:2px solid var(--edge);outline-offset:2px}
table{border-collapse:collapse;font-size:.9rem;line-height:1.35;font-variant-numeric:tabular-nums}
caption{text-align:left;font-size:.875rem;padding-bottom:.35rem;max-width:calc(100vw - 2rem)}
th,td{padding:.38rem .7rem;text-align:left;vertical-align:top;border-bottom:1px solid var(--rule)}
th:first-child{padding-left:0}
thead th{vertical-align:bottom;font-size:.8125rem;font-weight:600;color:var(--quiet);border-bottom-color:var(--edge)}
tbody th{font-weight:500}
.n{text-align:right;white-space:nowrap}
thead .n{white-space:normal}
.nw{white-space:nowrap}
.all th,.all td{font-weight:650;border-bottom:0}
.swatch{width:.85em;height:.85em;margin-right:.5em;vertical-align:-.06em}
.entry{display:inline-flex;align-items:baseline}.entry .swatch{flex:none;margin-bottom:-.06em}
.bar{stroke:var(--edge);stroke-width:.6}
.share{display:block;width:9rem;height:.95rem;margin-top:.12rem;border:1px solid var(--edge)}
.histogram{display:block;width:100%;max-width:30rem;height:auto;margin:1rem 0}
.histogram text{fill:var(--quiet)}
.grid{stroke:var(--rule)}
.mean{stroke:var(--ink);stroke-width:1.2;stroke-dasharray:3 3}
.legend{display:flex;flex-wrap:wrap;gap:.3rem 1.3rem;list-style:none;padding:0;font-size:.9rem}
.legend li{margin:0;font-variant-numeric:tabular-nums}
.road{display:inline-block;width:1.6em;height:0;border-top:2px solid var(--quiet);opacity:.6;margin-right:.5em;vertical-align:.25em}
figure{margin:1rem 0}
img{display:block;width:100%;height:auto;border:1px solid var(--rule);border-radius:.4rem}
.scale{display:flex;align-items:center;gap:.5rem;margin-bottom:.3rem;color:var(--ink)}
.scale span{height:.45rem;border:1px solid var(--ink);border-top:0}
.dark,.phone{display:none}
.cards{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,18rem),1fr));gap:1.25rem;margin:1.2rem 0}
.cards figure{margin:0}
.photos{display:grid;grid-template-columns:repeat(3,1fr);gap:.5rem;margin-top:.5rem}
.photos img{max-height:14rem;object-fit:contain}
.photos figcaption{font-size:.75rem;line-height:1.3;margin-top:.25rem}
figcaption{font-size:.875rem;line-height:1.4;font-variant-numeric:tabular-nums;margin-top:.45rem;overflow-wrap:anywhere}
figcaption h3{color:var(--ink);margin-bottom:.15rem}
figcaption b{color:var(--ink);font-weight:600}
a{color:inherit}
summary{cursor:pointer;margin:2.6rem 0 .6rem;padding-top:1.1rem;border-top:1px solid var(--rule)}
summary h2{display:inline;margin:0;padding:0;border:0}
summary:focus-visible,button:focus-visible,a:focus-visible{outline:2px solid var(--ink);outline-offset:2px}
.lead{max-width:none;font-size:clamp(1.2rem,1rem + 1vw,1.6rem);line-height:1.3;font-weight:600;margin:.9rem 0 1rem;overflow-wrap:anywhere}
nav{position:sticky;top:0;z-index:1;background:var(--page);border-bottom:1px solid var(--rule);margin-top:1rem}
nav ol{display:flex;gap:1.1rem;list-style:none;max-width:none;margin:0;padding:.55rem .1rem;overflow-x:auto;scrollbar-width:thin}
nav li{margin:0;white-space:nowrap;font-size:.875rem}
nav a{color:var(--quiet);text-decoration:none}
nav a:hover,nav a[aria-current]{color:var(--ink);text-decoration:underline}
details,.cards figure{scroll-margin-top:3.2rem}
.overview{margin:1.5rem 0}
.strip{display:block;width:100%;height:auto}
.strip text,.cards .histogram text{fill:var(--quiet)}
.cards .histogram{margin:.35rem 0 0}
.band{fill:var(--ink);opacity:.22}
th button{all:unset;cursor:pointer;display:inline}
th button:hover{text-decoration:underline}
th button:focus-visible{outline:2px solid var(--ink);outline-offset:2px}
th[aria-sort=ascending] button::after{content:" \25B2"}
th[aria-sort=descending] button::after{content:" \25BC"}
.save{font:inherit;font-size:.8125rem;color:var(--quiet);background:none;border:1px solid var(--rule);border-radius:.3rem;padding:.2rem .6rem;margin:-.4rem 0 1rem;cursor:pointer}
.save:hover{color:var(--ink);border-color:var(--quiet)}
@media screen and (min-width:34.01rem) and (max-width:54rem){.key{grid-template-columns:repeat(6,1fr)}
.key div{grid-column:span 2}.key div:nth-last-child(-n+2){grid-column:span 3}}
@media print,screen and (min-width:58rem){
.overview{display:grid;grid-template-columns:minmax(0,min(60%,26rem*var(--shape))) minmax(0,1fr);grid-template-rows:auto 1fr;gap:0 1.75rem}
.overview>*{min-width:0;margin:0}.overview .map{grid-column:1;grid-row:1/3}
.overview .legend,.overview .histogram{grid-column:2}.overview .histogram{margin-top:1.5rem}}
@media screen and (min-width:82rem){body{max-width:80rem;padding-left:15rem;position:relative}
nav{position:fixed;top:0;bottom:0;width:12.5rem;margin-left:-14rem;overflow-y:auto;border:0;padding-top:1.6rem}
nav ol{display:block}nav li{white-space:normal;padding:.3rem 0}}
)";

constexpr const char* on_a_phone = R"(
@media screen and (max-width:54rem){th,td{padding:.38rem .5rem}}
@media screen and (max-width:44rem){.else{display:none}.phone{display:inline}.strip{min-width:42rem}}
@media screen and (max-width:44rem){details:not([open])>summary{margin:.7rem 0;padding-top:.85rem}}
@media (max-width:34rem){table{font-size:.8125rem}th,td{padding:.35rem .4rem}.share{width:5rem}
.key{grid-template-columns:1fr 1fr;gap:.5rem}.key div:last-child:nth-child(odd){grid-column:1/-1}.key div{padding:.55rem .65rem}.key b{font-size:1.25rem}}
@media screen and (max-width:24rem){th,td{padding:.35rem .2rem}}
)";

constexpr const char* on_paper = R"(
@page{size:A4;margin:16mm 15mm}
@media print{body{max-width:none;padding:0;font-size:10pt;line-height:1.4}
h1{font-size:20pt}h2{font-size:13pt;margin-top:1.6rem;padding-top:.7rem}
h2,h3,caption{break-after:avoid}p,li{orphans:3;widows:3}
tr,figure,.key div,.histogram{break-inside:avoid}thead{display:table-header-group}
.wide{overflow:visible;break-inside:avoid}.long{break-inside:auto}.histogram{max-width:88mm}.legend{break-after:avoid}table{font-size:8.5pt}th,td{padding:.25rem .45rem}.share{width:5.5rem}
.key{grid-template-columns:repeat(3,1fr);gap:.5rem}.key b{font-size:14pt}
.cards{grid-template-columns:1fr 1fr 1fr;gap:.8rem}.cards figcaption{font-size:8.5pt}
.map{max-width:calc(135mm*var(--shape))}a{text-decoration:none}
nav,.save{display:none}th button{display:contents}summary{list-style:none;break-after:avoid}.strip{break-inside:avoid}}
)";

/// Returns rules that turn rows into blocks of titles and values on screens too narrow for columns.
std::string stacked(std::string_view kind, int width_rem) {
    std::string css = R"(
@media screen and (max-width:WIDTHrem){KIND,KIND tbody,KIND caption{display:block}KIND thead,KIND td:empty{display:none}
KIND tr{display:grid;grid-template-columns:repeat(auto-fill,minmax(5.5rem,1fr));gap:.3rem .8rem;padding:.55rem 0;border-bottom:1px solid var(--rule)}
KIND th,KIND td{padding:0;border:0;text-align:left;white-space:normal}KIND th{grid-column:1/-1;font-weight:600}
KIND td::before{content:attr(data-t);display:block;color:var(--quiet);font-size:.75rem;font-weight:400}}
)";
    const auto replace = [&css](std::string_view word, std::string_view by) {
        for (auto at = css.find(word); at != std::string::npos; at = css.find(word, at)) {
            css.replace(at, word.size(), by);
        }
    };
    replace("KIND", kind);
    replace("WIDTH", std::to_string(width_rem));
    return css;
}

} // namespace

std::string report_style() {
    using enum MapStyle::Theme;
    return fmt::format(":root{{color-scheme:light dark;{}}}\n"
                       "@media screen and (prefers-color-scheme:dark){{:root{{{}}}}}\n"
                       "@media print{{:root{{color-scheme:light;{}}}}}\n"
                       "{}@media screen and (prefers-color-scheme:dark){{.light{{display:none}}"
                       ".dark{{display:block}}}}{}{}{}{}",
                       colours_of(light),
                       colours_of(dark),
                       colours_of(print),
                       rules,
                       on_a_phone,
                       stacked(".stack", 31),
                       stacked(".many", 50),
                       on_paper);
}

std::string_view page_script() {
    return R"(
'use strict';
const { csv, sort, mark } = document.body.dataset;
const all = (selector, of = document) => [...of.querySelectorAll(selector)];
const words = (cell) => (cell.querySelector('svg.share') || cell).ariaLabel || cell.innerText.trim();

// Sections are folded on phones, but not those that a link leads to, and none on paper.
const sections = all('main details');
const unfold = () => {
  const target = location.hash.length > 1 && document.getElementById(location.hash.slice(1));
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
    return /^[+-]?\d+(\.\d+)?$/.test(bare) ? bare : text.replaceAll('\n', '; ').replaceAll('\u00a0', ' ');
  };
  return all('tr', table).map((row) => [...row.cells].map((cell) => {
    const text = plain(words(cell));
    const formula = /^[=@\t\r+-]/.test(text) && !/^[+-]?\d+(\.\d+)?$/.test(text);
    return field(formula ? `'${text}` : text); // of a spreadsheet
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
