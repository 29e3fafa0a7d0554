// SPDX-License-Identifier: MIT
// How report.html looks.
#pragma once

namespace relume::app {

inline constexpr const char* kReportStyle = R"(
:root { color-scheme: light dark; --ink: #1c2024; --soft: #646b76; --line: #dcdfe4; --paper: #f7f7f4; --card: #ffffff;
  --bar: #3f74b5; --mark: #c2571a; --good: #2c7a4b; --watch: #a8660a; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #e7e8ea; --soft: #9aa2ae; --line: #31363e; --paper: #131518; --card: #1b1e23;
  --bar: #6fa3e0; --mark: #f0965a; --good: #6cc28d; --watch: #e2b05a; --bad: #f2867e; } }
* { box-sizing: border-box; }
body { font: 16px/1.55 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; color: var(--ink); background: var(--paper);
  margin: 0 auto; max-width: 1200px; padding: 2.5rem 1.5rem 5rem; }
h1 { font-size: 1.8rem; line-height: 1.2; margin: 0; letter-spacing: -.01em; }
h2 { font-size: 1.3rem; margin: 3.2rem 0 .4rem; padding-top: 1.2rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.02rem; margin: 1.8rem 0 .5rem; }
p { max-width: 78ch; margin: .4rem 0 1rem; } .soft { color: var(--soft); } small { color: var(--soft); font-size: .86em; }
nav { margin: .9rem 0 0; display: flex; flex-wrap: wrap; gap: .3rem 1.1rem; font-size: .93rem; } a { color: var(--bar); text-decoration: none; } a:hover { text-decoration: underline; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(172px, 1fr)); gap: .8rem; margin: 1.6rem 0 1rem; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: .8rem 1rem .9rem; }
.card b { display: block; font-size: 1.5rem; font-weight: 650; line-height: 1.25; font-variant-numeric: tabular-nums; } .card span { color: var(--soft); font-size: .86rem; display: block; line-height: 1.4; }
.good { color: var(--good); } .watch { color: var(--watch); } .bad { color: var(--bad); }
ul.notes { list-style: none; margin: 1rem 0; padding: 0; } ul.notes li { padding: .45rem 0 .45rem 1.5rem; position: relative; max-width: 90ch; }
ul.notes li::before { content: ""; position: absolute; left: .2rem; top: .98rem; width: .6rem; height: .6rem; border-radius: 50%; background: currentColor; }
ul.notes li > span { color: var(--ink); }
.grid { display: grid; grid-template-columns: repeat(auto-fill, minmax(300px, 1fr)); gap: 1rem; } .grid.three { grid-template-columns: repeat(3, 1fr); } @media (max-width: 640px) { .grid.three { grid-template-columns: 1fr; } }
.two { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(440px, 100%), 1fr)); gap: 0 2.2rem; align-items: start; }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 10px; overflow: hidden; }
figure.wide { grid-column: 1 / -1; } img { display: block; width: 100%; height: auto; } img.texels { image-rendering: pixelated; }
figcaption { padding: .55rem .85rem .65rem; font-size: .86rem; color: var(--soft); line-height: 1.4; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; width: 100%; font-size: .91rem; }
th, td { text-align: left; padding: .36rem .9rem .36rem 0; border-bottom: 1px solid var(--line); vertical-align: baseline; white-space: nowrap; }
td.name { white-space: normal; min-width: 9rem; overflow-wrap: anywhere; } th { font-weight: 600; color: var(--soft); } td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; } th:last-child, td:last-child { padding-right: 0; }
svg.plot { display: block; width: 100%; max-width: 620px; height: auto; margin: .3rem 0 .8rem; } svg text { font: 12px system-ui, sans-serif; fill: var(--ink); } svg text.label { fill: var(--soft); }
svg .bar { fill: var(--bar); } svg .axis { stroke: var(--line); } svg line.marker { stroke: var(--mark); stroke-dasharray: 4 3; } svg text.marker { fill: var(--mark); }
.key i { display: inline-block; width: .72rem; height: .72rem; border-radius: 3px; margin: 0 .35rem 0 .9rem; } .key i:first-child { margin-left: 0; }
pre { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: .8rem 1rem; font: 13px/1.5 ui-monospace, "DejaVu Sans Mono", monospace; white-space: pre-wrap; overflow-wrap: anywhere; user-select: all; margin: .4rem 0 1rem; }
table.narrow { width: auto; } table.narrow td, table.narrow th { padding-right: 2.4rem; }
details summary { cursor: pointer; color: var(--soft); margin: .8rem 0; font-size: .92rem; }
@media print { body { max-width: none; } figure, .card { break-inside: avoid; } }
)";

}  // namespace relume::app
