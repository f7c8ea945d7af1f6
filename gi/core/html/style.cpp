#include "gi/core/html/html.h"

namespace gi {

// Colours of Okabe & Ito 2008, which colour-blind people tell apart; brighter on dark paper.
// The scale of FLIP is that of gi/metrics/difference_image.cpp.
std::string_view html_style()
{
    return R"(:root { --paper: #fff; --ink: #1c1c1e; --faint: #5c5c66; --rule: #e0e0e6; --box: #f6f6f9; --band: #0072b226;
  --c0: #0072b2; --c1: #c24e00; --c2: #007a5a; --c3: #b0508a; --c4: #8a6a00; --c5: #3a7fae; }
@media screen and (prefers-color-scheme: dark) {
  :root { --paper: #17181b; --ink: #ececf0; --faint: #a0a0aa; --rule: #34363c; --box: #212328; --band: #56b4e933;
    --c0: #56b4e9; --c1: #f08a3c; --c2: #2cc79b; --c3: #e39ac4; --c4: #e6b422; --c5: #9fc5e8; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem; max-width: 78rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
h1 { margin: 0; font-size: 1.9rem; line-height: 1.25; }
h2 { margin: 2.2rem 0 .6rem; padding-top: 1rem; border-top: 1px solid var(--rule); font-size: 1.45rem; }
h3 { margin: 1.6rem 0 .4rem; font-size: 1.15rem; }
h4 { margin: .9rem 0 .3rem; font-size: 1rem; }
p { max-width: 48rem; }
.note, figcaption, .about, small { color: var(--faint); font-size: .9rem; }
.note { margin: .2rem 0 .6rem; } .about { margin: .2rem 0 0; }
.cautions { margin: 1rem 0; padding: .6rem 1rem .6rem 2.2rem; background: var(--box); border-left: 4px solid var(--c1);
  border-radius: 4px; }
.findings li { margin: .3rem 0; max-width: 52rem; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .1rem 1.2rem; margin: .5rem 0; font-size: .9rem; }
dt { color: var(--faint); } dd { margin: 0; overflow-wrap: anywhere; }
pre { margin: .3rem 0; padding: .7rem 1rem; background: var(--box); border-radius: 6px; white-space: pre-wrap;
  overflow-wrap: anywhere; }
summary, label { cursor: pointer; color: var(--faint); font-size: .9rem; }
.scroll { overflow-x: auto; margin-bottom: .6rem; }
table { border-collapse: collapse; font-size: .86rem; font-variant-numeric: tabular-nums; }
th, td { padding: .22rem .45rem; border-bottom: 1px solid var(--rule); text-align: left; vertical-align: top; }
th { vertical-align: bottom; color: var(--faint); font-weight: 600; }
th.number, .number { text-align: right; } td.number { white-space: nowrap; }
td small { display: block; font-size: .78rem; }
div.bar { height: .7rem; margin-top: .3rem; background: var(--c0); } div.out { background: var(--c1); }
.matrix caption { padding: .2rem 0; font-weight: 600; text-align: left; }
.matrix td { min-width: 2.9rem; text-align: center; border: 1px solid var(--rule);
  background: color-mix(in srgb, var(--c0) var(--share, 0%), transparent); }
.matrix td.lost { background: color-mix(in srgb, var(--c1) var(--share, 0%), transparent); }
.matrix th[scope=row] { text-align: right; } .matrix thead th { text-align: center; }
.figures { display: flex; flex-wrap: wrap; gap: 1.2rem; align-items: flex-start; }
figure { margin: 0; max-width: 100%; } figure.wide { width: 100%; margin-bottom: 1rem; }
.small { display: flex; flex-wrap: wrap; gap: .5rem; }
figcaption { margin-top: .25rem; } figcaption b { color: var(--ink); }
svg { display: block; max-width: 100%; height: auto; background: var(--box); border-radius: 6px; }
svg text { fill: var(--ink); font-size: 12px; }
svg .tick { fill: var(--faint); font-size: 11px; } svg .label { fill: var(--faint); }
svg .grid { stroke: var(--rule); } svg .axis { stroke: var(--faint); }
svg .interval { stroke: var(--c0); stroke-width: 2; } svg .thin { stroke-width: 1; opacity: .7; }
svg .point { fill: var(--c0); } svg .base { fill: var(--c1); }
svg .ring { fill: none; stroke: var(--c2); stroke-width: 2.5; }
svg .equal { stroke: var(--faint); stroke-width: 3; stroke-linecap: round; }
svg .truth { fill: none; stroke: var(--c1); stroke-width: 1.8; }
svg .bar { fill: var(--c0); opacity: .45; }
svg .band { fill: var(--band); } svg .mark { stroke: var(--c2); stroke-dasharray: 4 3; stroke-width: 1.5; }
svg .level { stroke: var(--faint); stroke-dasharray: 5 4; }
svg .fit { fill: none; stroke: var(--ink); stroke-width: 1.8; } svg .track { fill: none; stroke: var(--faint); }
svg .right { fill: var(--c0); } svg .wrong { fill: var(--paper); stroke: var(--c0); }
.c0 { stroke: var(--c0); fill: var(--c0); } .c1 { stroke: var(--c1); fill: var(--c1); }
.c2 { stroke: var(--c2); fill: var(--c2); } .c3 { stroke: var(--c3); fill: var(--c3); }
.c4 { stroke: var(--c4); fill: var(--c4); } .c5 { stroke: var(--c5); fill: var(--c5); }
svg .curve { fill: none; stroke-width: 2; } svg .dashed .curve { stroke-dasharray: 7 4; } svg .dotted .curve { stroke-dasharray: 2 3; } svg .spread { stroke-width: 1.5; opacity: .6; }
svg .name { stroke: none; font-weight: 600; }
.charts { display: flex; flex-wrap: wrap; gap: 1rem; }
.pictures { display: grid; grid-template-columns: max-content minmax(0, 1fr); gap: 0 1rem; }
.pictures > div:first-child { position: sticky; top: 0; align-self: start; }
.strip { display: flex; gap: .8rem; overflow-x: auto; padding-bottom: .6rem; }
.pictures figure { width: 208px; flex: none; }
.pictures img { display: block; width: 208px; height: auto; margin-bottom: 4px; image-rendering: pixelated;
  cursor: zoom-in; }
.pictures img:focus { position: fixed; inset: 0; z-index: 1; margin: auto; width: auto; max-width: 96vw;
  max-height: 96vh; outline: 100vmax solid rgb(0 0 0 / .75); cursor: default; }
.pair { display: flex; gap: .5rem; }
.pair figure, .renders figure { min-width: 0; flex: 1 1 30rem; }
.renders { display: flex; flex-wrap: wrap; gap: 1rem; margin-top: 1rem; }
.renders figure { max-width: 40rem; }
.pair img, .renders img, .renders video, details img { display: block; width: 100%; height: auto;
  border-radius: 4px; }
details img { max-width: 40rem; margin-top: .5rem; }
label { display: block; margin-bottom: .4rem; }
label:has(.swap:checked) + .pair { flex-direction: row-reverse; }
.missing { padding: .5rem; background: var(--box); color: var(--faint); font-size: .85rem; }
.scale { display: inline-block; width: 9rem; height: .7rem; margin: 0 .4rem; vertical-align: baseline;
  background: linear-gradient(to right, #000004, #3b0f70, #8c2981, #dd4968, #fe9f6d, #fcfdbf); }
@media (max-width: 40rem) { .pictures { grid-template-columns: minmax(0, 1fr); } }
@page { size: A4; margin: 14mm; }
@media print {
  body { padding: 0; max-width: none; font-size: 10.5pt; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  .scroll, .strip { overflow: visible; flex-wrap: wrap; }
  table { font-size: 7.5pt; } th, td { padding: .12rem .3rem; } .matrix { font-size: 8pt; }
  figure, tr, svg, li { break-inside: avoid; } h2, h3, .note, .prompt { break-after: avoid; }
  td { min-width: 0 !important; }
  figure.wide { break-inside: auto; }
  .figures { gap: 3mm; } .figures > figure { width: 48% !important; } .figures > figure svg { width: 100%; }
  .figures > figure:has(.matrix) { width: auto !important; }
  .small svg { width: 19%; } figcaption, .note, .about { font-size: 8.5pt; } h1 { font-size: 18pt; } h2 { font-size: 14pt; }
}
)";
}

} // namespace gi
