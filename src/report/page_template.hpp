/// The text of the index page (private to src/report). Mustache: {{x}} is escaped, {{{x}}} is not.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {

inline constexpr const char* kPageTemplate = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{{title}}</title>
<style>
:root { --ink: #1d2126; --soft: #5b6470; --line: #d9dee4; --page: #f6f7f9; --card: #ffffff; --accent: #1f69a8; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e9ed; --soft: #9aa5b1; --line: #353c45; --page: #14171b; --card: #1c2026; --accent: #6fb0e6; }
}
* { box-sizing: border-box; }
html { scroll-behavior: smooth; scroll-padding-top: 3.4rem; }
@media (prefers-reduced-motion: reduce) { html { scroll-behavior: auto; } }
body { margin: 0; background: var(--page); color: var(--ink); font: 16px/1.55 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
main { max-width: 70rem; margin: 0 auto; padding: 1.5rem 1rem 3rem; }
h1 { font-size: 1.8rem; line-height: 1.2; margin: 0 0 .4rem; }
h2 { font-size: 1.4rem; line-height: 1.25; margin: 0 0 .6rem; }
h3 { font-size: 1.05rem; margin: 1.8rem 0 .5rem; }
section { margin-top: 2.2rem; padding-top: 1.8rem; border-top: 2px solid var(--line); }
p { margin: .5rem 0; max-width: 50rem; }
.lead { color: var(--soft); font-size: 1.05rem; }
.note { color: var(--soft); font-size: .9rem; }
nav { position: sticky; top: 0; z-index: 1; background: var(--page); border-bottom: 1px solid var(--line); }
nav div { max-width: 70rem; margin: 0 auto; padding: .5rem 1rem; display: flex; gap: .3rem 1.2rem; overflow-x: auto; white-space: nowrap; font-size: .92rem; }
@media (min-width: 48rem) { html { scroll-padding-top: 5rem; } nav div { flex-wrap: wrap; } }
nav a, .index a { text-decoration: none; }
nav a:hover, .index a:hover b { text-decoration: underline; }
.index { display: grid; grid-template-columns: repeat(auto-fit, minmax(16rem, 1fr)); gap: .8rem; margin: 1.4rem 0; }
.index a { color: inherit; }
.index b { display: block; color: var(--accent); }
.index span { color: var(--soft); font-size: .92rem; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: .6rem; padding: 1rem; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(9rem, 1fr)); gap: .8rem; margin: 1.2rem 0; }
.figures b { display: block; font-size: 1.5rem; line-height: 1.2; color: var(--accent); }
.figures span { color: var(--soft); font-size: .9rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .92rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .35rem .7rem; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--soft); font-weight: 600; white-space: nowrap; vertical-align: bottom; }
td.n, th.n { text-align: right; white-space: nowrap; }
td:last-child:not(.n) { min-width: 12rem; }
tr:last-child td { border-bottom: 0; }
.state { display: inline-block; color: #fff; border-radius: 1rem; padding: .05rem .65rem; font-size: .85rem; white-space: nowrap; }
svg { display: block; width: 100%; min-width: 44rem; height: auto; color: var(--ink); }
pre { overflow-x: auto; margin: .6rem 0; padding: .8rem 1rem; background: var(--card); border: 1px solid var(--line); border-radius: .6rem; font-size: .87rem; }
ol, ul { padding-left: 1.5rem; max-width: 50rem; margin: .5rem 0; }
li { margin: .3rem 0; }
a { color: var(--accent); }
.top { font-size: .9rem; }
footer { margin-top: 2.5rem; padding-top: 1rem; border-top: 2px solid var(--line); color: var(--soft); font-size: .88rem; }
@media print { body { background: #fff; } nav, .top { display: none; } .card { break-inside: avoid; } svg { min-width: 0; } }
</style>
</head>
<body id="top">
<nav aria-label="Chapters"><div>{{#chapters}}<a href="#{{id}}">{{title}}</a>{{/chapters}}</div></nav>
<main>
<h1>{{title}}</h1>
<p class="lead">{{lead}}</p>
<div class="index">
{{#chapters}}<a class="card" href="#{{id}}"><b>{{title}}</b><span>{{gist}}</span></a>
{{/chapters}}
</div>
{{#chapters}}
<section id="{{id}}">
<h2>{{title}}</h2>
{{#text}}<p>{{text}}</p>
{{/text}}
{{#has_figures}}<div class="figures">
{{#figures}}<div class="card"><b>{{value}}</b><span>{{label}}</span></div>
{{/figures}}
</div>
{{/has_figures}}
{{#has_story}}<h3>What happened</h3>
<ol>
{{#story}}<li>{{text}}</li>
{{/story}}
</ol>
{{/has_story}}
{{#pictures}}{{#has_title}}<h3>{{title}}</h3>
{{/has_title}}
<div class="card wide">
{{#has_svg}}{{{svg}}}{{/has_svg}}{{^has_svg}}<p>There is no picture: {{missing}}</p>{{/has_svg}}
</div>
{{#has_caption}}<p class="note">{{caption}}</p>
{{/has_caption}}
{{/pictures}}
{{#tables}}{{#has_title}}<h3>{{title}}</h3>
{{/has_title}}
<div class="card wide">
<table>
<thead><tr>{{#head}}<th{{#numeric}} class="n"{{/numeric}}>{{text}}</th>{{/head}}</tr></thead>
<tbody>
{{#rows}}<tr>{{#cells}}<td{{#numeric}} class="n"{{/numeric}}>{{#is_state}}<span class="state" style="background:{{colour}}">{{text}}</span>{{/is_state}}{{^is_state}}{{text}}{{/is_state}}</td>{{/cells}}</tr>
{{/rows}}
</tbody>
</table>
</div>
{{#has_note}}<p class="note">{{note}}</p>
{{/has_note}}
{{/tables}}
{{#has_commands}}<h3>Do it by hand</h3>
<p>The demo used no private path: these commands give the same bytes.</p>
<pre>{{#commands}}{{text}}
{{/commands}}</pre>
{{/has_commands}}
{{#has_files}}<h3>Files</h3>
<ul>
{{#files}}<li><a href="{{name}}">{{name}}</a>: {{what}}</li>
{{/files}}
</ul>
{{/has_files}}
<p class="top"><a href="#top">To the top</a></p>
</section>
{{/chapters}}
<footer>{{footer}}</footer>
</main>
</body>
</html>
)html";

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb
