/// The text of the index page (private to src/report). Mustache: {{x}} is escaped, {{{x}}} is not.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {

inline constexpr const char* kRunPageTemplate = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{{title}}</title>
<style>
:root { --ink: #1d2126; --soft: #5b6470; --line: #d9dee4; --page: #f6f7f9; --card: #ffffff; --accent: #2f78b7; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e9ed; --soft: #9aa5b1; --line: #353c45; --page: #14171b; --card: #1c2026; --accent: #6fb0e6; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 16px/1.55 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
main { max-width: 66rem; margin: 0 auto; padding: 1.5rem 1rem 3rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .3rem; }
h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem; }
p { margin: .5rem 0; max-width: 48rem; }
.lead { color: var(--soft); font-size: 1.05rem; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: .6rem; padding: 1rem; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(11rem, 1fr)); gap: .8rem; margin: 1.4rem 0; }
.figures b { display: block; font-size: 1.6rem; line-height: 1.2; color: var(--accent); }
.figures span { color: var(--soft); font-size: .9rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .92rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .4rem .7rem; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--soft); font-weight: 600; white-space: nowrap; }
td.n, th.n { text-align: right; white-space: nowrap; }
td small { display: block; color: var(--soft); min-width: 14rem; }
tr:last-child td { border-bottom: 0; }
.state { display: inline-block; color: #fff; border-radius: 1rem; padding: .05rem .65rem; font-size: .85rem; white-space: nowrap; }
.states { display: grid; grid-template-columns: max-content 1fr; gap: .45rem .8rem; align-items: baseline; }
svg { display: block; width: 100%; min-width: 44rem; height: auto; color: var(--ink); }
pre { overflow-x: auto; margin: .6rem 0; padding: .8rem 1rem; background: var(--card); border: 1px solid var(--line); border-radius: .6rem; font-size: .87rem; }
ol, ul { padding-left: 1.3rem; max-width: 48rem; }
li { margin: .3rem 0; }
a { color: var(--accent); }
footer { margin-top: 2.5rem; color: var(--soft); font-size: .85rem; }
@media print { body { background: #fff; } .card { break-inside: avoid; } }
</style>
</head>
<body>
<main>
<h1>{{title}}</h1>
<p class="lead">{{lead}}</p>
<div class="figures">
{{#figures}}<div class="card"><b>{{value}}</b><span>{{label}}</span></div>
{{/figures}}
</div>

<h2>What happened</h2>
<ol>
{{#story}}<li>{{text}}</li>
{{/story}}
</ol>

<h2>The run in one picture</h2>
<div class="card wide">
{{#has_plot}}{{{plot}}}{{/has_plot}}{{^has_plot}}<p>There is no plot: {{plot_missing}}</p>{{/has_plot}}
</div>
<p>Every dot is one block of samples taken while the tool stands still; the gaps are the moves between stations, when plumb
holds its judgement. <em>Without plumb</em> is the plain least-squares answer of all sensors with the same calibration. Amber dots
are answers that plumb itself calls unconfirmed. Inclination is that of the array's own frame: gravity cannot tell how the array as a
whole sits in its housing.</p>

<h2>Timeline</h2>
<div class="card wide">
<table>
<thead><tr><th class="n">time, s</th><th>state</th><th>why</th><th>sensor</th><th class="n">statistic</th><th class="n">limit</th><th class="n">inclination, deg</th><th>output</th></tr></thead>
<tbody>
{{#rows}}<tr><td class="n">{{time}}</td><td><span class="state" style="background:{{colour}}">{{state}}</span></td><td>{{cause}}<small>{{explanation}}</small></td><td>{{sensors}}</td><td class="n">{{statistic}}</td><td class="n">{{limit}}</td><td class="n">{{inclination}}</td><td>{{output}}</td></tr>
{{/rows}}
</tbody>
</table>
</div>
<p>An alarm is a statistic above its limit; both are in standard deviations of the noise (for cause <em>mae</em>: in m/s²). The limit
carries the noise and what the calibration and gravity are not sure of.</p>

<h2>What the states mean</h2>
<div class="card states">
{{#states}}<span class="state" style="background:{{colour}}">{{name}}</span><span>{{meaning}}</span>
{{/states}}
</div>

<h2>Calibration</h2>
<p>{{calibration}}</p>
<div class="card wide">
<table>
<thead><tr><th>sensor</th><th class="n">bias, mg</th><th class="n">scale, V/g</th><th class="n">axis off nominal, deg</th><th class="n">left after calibration, mg</th><th class="n">residual, mg rms</th></tr></thead>
<tbody>
{{#sensors}}<tr><td>{{id}}</td><td class="n">{{bias}}</td><td class="n">{{scale}}</td><td class="n">{{axis}}</td><td class="n">{{e_cal}}</td><td class="n">{{residual}}</td></tr>
{{/sensors}}
</tbody>
</table>
</div>
<p>g = 9.80665 m/s², mg = g/1000. ± is one standard deviation.</p>

<h2>Do it by hand</h2>
<p>The demo used no private path. In this directory, these commands give the same results:</p>
<pre>{{#commands}}{{text}}
{{/commands}}</pre>

<h2>Files</h2>
<ul>
{{#files}}<li><a href="{{name}}">{{name}}</a>: {{what}}</li>
{{/files}}
</ul>
<footer>{{footer}}</footer>
</main>
</body>
</html>
)html";

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
