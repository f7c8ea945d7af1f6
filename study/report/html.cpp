#include "study/report/html.h"

#include "gi/core/html.h"
#include "study/report/plot.h"

#include <fmt/format.h>

namespace study {

std::string html_of(ResultTable const& t)
{
    std::string html = fmt::format("<h3>{}</h3>\n", gi::escaped(t.title));
    if (!t.note.empty()) html += fmt::format("<p class=\"note\">{}</p>\n", gi::escaped(t.note));
    html += "<div class=\"scroll\"><table><thead><tr>";
    std::vector<bool> is_number(t.table.columns.size(), true);
    for (std::size_t c = 0; c < t.table.columns.size(); ++c)
        for (auto const& row : t.table.rows)
            if (row[c] != kNothing && row[c].find_first_not_of("0123456789+-.e") != std::string::npos)
                is_number[c] = false;
    for (std::size_t c = 0; c < t.table.columns.size(); ++c) {
        Column const& column = t.table.columns[c];
        std::string name = column.name;
        for (char& letter : name)
            if (letter == '_') letter = ' ';
        html += fmt::format("<th scope=\"col\"{} title=\"{}\">{}</th>", is_number[c] ? " class=\"number\"" : "",
                            gi::escaped(column.description), gi::escaped(name));
    }
    html += "</tr></thead><tbody>\n";
    for (auto const& row : t.table.rows) {
        html += "<tr>";
        for (std::size_t c = 0; c < row.size(); ++c)
            html += fmt::format("<td{}>{}</td>", is_number[c] ? " class=\"number\"" : "",
                                gi::escaped(shown_cell(t.table.columns[c], row[c])));
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

// Colours of Okabe & Ito 2008, which colour-blind people tell apart.
std::string_view report_style()
{
    return R"(:root { --paper: #fff; --ink: #1c1c1e; --faint: #5c5c66; --rule: #e0e0e6; --box: #f6f6f9; --blue: #0072b2;
  --orange: #c24e00; --green: #007a5a; --band: #0072b226; }
@media screen and (prefers-color-scheme: dark) {
  :root { --paper: #17181b; --ink: #ececf0; --faint: #a0a0aa; --rule: #34363c; --box: #212328; --blue: #56b4e9;
    --orange: #f08a3c; --green: #2cc79b; --band: #56b4e933; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem; max-width: 76rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
h1 { margin: 0; font-size: 1.9rem; line-height: 1.25; }
h2 { margin: 2.2rem 0 .6rem; padding-top: 1rem; border-top: 1px solid var(--rule); font-size: 1.45rem; }
h3 { margin: 1.6rem 0 .4rem; font-size: 1.1rem; }
p { max-width: 48rem; }
.note, figcaption, .about { color: var(--faint); font-size: .9rem; }
.about { margin: .2rem 0 0; }
.cautions { margin: 1rem 0; padding: .6rem 1rem .6rem 2.2rem; background: var(--box); border-left: 4px solid var(--orange);
  border-radius: 4px; }
.findings li { margin: .3rem 0; max-width: 52rem; }
.figures { display: flex; flex-wrap: wrap; gap: 1.2rem; align-items: flex-start; }
figure { margin: 0; max-width: 100%; }
figure.wide { width: 100%; }
.small { display: flex; flex-wrap: wrap; gap: .5rem; }
figcaption { margin-top: .25rem; } figure.wide { margin-bottom: 1rem; } figcaption b { color: var(--ink); }
svg { display: block; max-width: 100%; height: auto; background: var(--box); border-radius: 6px; }
svg text { fill: var(--ink); font-size: 12px; }
svg .tick { fill: var(--faint); font-size: 11px; } svg .label { fill: var(--faint); }
svg .grid { stroke: var(--rule); } svg .axis { stroke: var(--faint); }
svg .interval { stroke: var(--blue); stroke-width: 2; } svg .thin { stroke-width: 1; opacity: .7; }
svg .point { fill: var(--blue); } svg .base { fill: var(--orange); }
svg .ring { fill: none; stroke: var(--green); stroke-width: 2.5; }
svg .equal { stroke: var(--faint); stroke-width: 3; stroke-linecap: round; }
svg .truth { fill: none; stroke: var(--orange); stroke-width: 1.8; }
svg .bar { fill: var(--blue); opacity: .45; }
svg .band { fill: var(--band); } svg .mark { stroke: var(--green); stroke-dasharray: 4 3; stroke-width: 1.5; }
svg .fit { fill: none; stroke: var(--ink); stroke-width: 1.8; } svg .track { fill: none; stroke: var(--faint); }
svg .right { fill: var(--blue); } svg .wrong { fill: var(--paper); stroke: var(--blue); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .82rem; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .42rem; border-bottom: 1px solid var(--rule); text-align: left; vertical-align: top; }
th { vertical-align: bottom; color: var(--faint); font-weight: 600; }
.number { text-align: right; white-space: nowrap; }
.matrix caption { padding: .2rem 0; font-weight: 600; text-align: left; }
.matrix td { min-width: 2.9rem; text-align: center; border: 1px solid var(--rule);
  background: color-mix(in srgb, var(--blue) var(--share, 0%), transparent); }
.matrix td.lost { background: color-mix(in srgb, var(--orange) var(--share, 0%), transparent); }
.matrix th[scope=row] { text-align: right; } .matrix thead th { text-align: center; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .1rem 1.2rem; font-size: .9rem; }
dt { color: var(--faint); } dd { margin: 0; overflow-wrap: anywhere; }
@page { size: A4; margin: 14mm; }
@media print {
  body { padding: 0; max-width: none; font-size: 10.5pt; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  .scroll { overflow: visible; }
  table { font-size: 7.5pt; } th, td { padding: .12rem .3rem; } .matrix { font-size: 8pt; }
  figure, tr, svg, li { break-inside: avoid; } h2, h3 { break-after: avoid; }
  figure.wide { break-inside: auto; }
  .figures { gap: 3mm; } .figures > figure { width: 48% !important; } .figures > figure svg { width: 100%; }
  .figures > figure:has(.matrix) { width: auto !important; }
  .small svg { width: 19%; } figcaption, .note, .about { font-size: 8.5pt; } h1 { font-size: 18pt; } h2 { font-size: 14pt; }
}
)";
}

} // namespace study
