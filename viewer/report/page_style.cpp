#include "viewer/report/page.h"

namespace viewer {

// Curves have the colours of Okabe & Ito 2008, which colour-blind people can distinguish; brighter on dark paper.
// The scale of FLIP is that of gi/metrics/difference_image.cpp.
std::string_view page_style()
{
    return R"(:root { --paper: #fff; --ink: #1c1c1e; --faint: #63636b; --rule: #e2e2e7; --box: #f5f5f8;
  --c0: #0072b2; --c1: #c24e00; --c2: #007a5a; --c3: #b0508a; --c4: #8a6a00; --c5: #3a7fae; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #17181b; --ink: #ececf0; --faint: #a0a0aa; --rule: #34363c; --box: #212328;
    --c0: #56b4e9; --c1: #f08a3c; --c2: #2cc79b; --c3: #e39ac4; --c4: #e6b422; --c5: #9fc5e8; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem; max-width: 78rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
h1 { margin: 0; font-size: 1.9rem; }
h2 { margin: 2rem 0 .6rem; padding-top: 1rem; border-top: 1px solid var(--rule); font-size: 1.45rem; }
h3 { margin: 1.8rem 0 .4rem; font-size: 1.15rem; }
h4 { margin: .9rem 0 .3rem; font-size: 1rem; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1.2rem; margin: .5rem 0; }
dt, .note, small { color: var(--faint); }
dd { margin: 0; overflow-wrap: anywhere; }
.note { margin: .2rem 0 .6rem; font-size: .9rem; }
pre { margin: .3rem 0; padding: .7rem 1rem; background: var(--box); border-radius: 6px; white-space: pre-wrap;
  overflow-wrap: anywhere; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .5rem; border-bottom: 1px solid var(--rule); text-align: left; vertical-align: top;
  white-space: nowrap; }
th { vertical-align: bottom; white-space: normal; }
th.number, .number { text-align: right; }
td small { display: block; font-size: .78rem; }
.charts { display: flex; flex-wrap: wrap; gap: 1rem; }
.charts figure { flex: 1 1 30rem; min-width: 0; max-width: 40rem; margin: 0; }
figcaption { font-size: .85rem; }
svg { display: block; width: 100%; height: auto; background: var(--box); border-radius: 6px; }
svg text { fill: var(--ink); font-size: 13px; }
svg .tick { fill: var(--faint); font-size: 12px; }
svg .middle { text-anchor: middle; }
svg .end { text-anchor: end; }
svg .grid { stroke: var(--rule); }
svg .axis { stroke: var(--faint); }
svg .level { stroke: var(--faint); stroke-dasharray: 5 4; }
.curve polyline { fill: none; stroke-width: 2; }
.curve .spread { stroke-width: 1.5; opacity: .6; }
.curve .sample { stroke-width: 2; }
.c0 { stroke: var(--c0); fill: var(--c0); } .c1 { stroke: var(--c1); fill: var(--c1); }
.c2 { stroke: var(--c2); fill: var(--c2); } .c3 { stroke: var(--c3); fill: var(--c3); }
.c4 { stroke: var(--c4); fill: var(--c4); } .c5 { stroke: var(--c5); fill: var(--c5); }
.name { stroke: none; }
svg .name text { fill: inherit; font-weight: 600; }
.pictures { display: grid; grid-template-columns: max-content minmax(0, 1fr); gap: 0 1rem; }
.pictures > div:first-child { position: sticky; top: 0; align-self: start; }
.strip { display: flex; gap: .8rem; overflow-x: auto; padding-bottom: .6rem; }
.pictures figure { margin: 0; width: 208px; flex: none; }
.pictures img { display: block; width: 208px; height: auto; margin-bottom: 4px; image-rendering: pixelated;
  cursor: zoom-in; }
.pictures img:focus { position: fixed; inset: 0; z-index: 1; margin: auto; width: auto; max-width: 96vw;
  max-height: 96vh; outline: 100vmax solid rgb(0 0 0 / .75); cursor: default; }
.pair { display: flex; gap: .5rem; }
.pair figure, .renders figure { margin: 0; min-width: 0; flex: 1 1 30rem; }
.renders { display: flex; flex-wrap: wrap; gap: 1rem; margin-top: 1rem; }
.renders figure { max-width: 40rem; }
.pair img, .renders img, .renders video, details img { display: block; width: 100%; height: auto;
  border-radius: 4px; }
details img { max-width: 40rem; margin-top: .5rem; }
summary, label { cursor: pointer; color: var(--faint); font-size: .9rem; }
label { display: block; margin-bottom: .4rem; }
label:has(.swap:checked) + .pair { flex-direction: row-reverse; }
.missing { padding: .5rem; background: var(--box); color: var(--faint); font-size: .85rem; }
.scale { display: inline-block; width: 9rem; height: .7rem; margin: 0 .4rem; vertical-align: baseline;
  background: linear-gradient(to right, #000004, #3b0f70, #8c2981, #dd4968, #fe9f6d, #fcfdbf); }
@media (max-width: 40rem) { .pictures { grid-template-columns: minmax(0, 1fr); } }
@media print { .strip, .wide { overflow: visible; flex-wrap: wrap; } }
)";
}

} // namespace viewer
