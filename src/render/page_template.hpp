/// The text of all pages (private to src/render). Mustache: {{x}} is escaped, {{{x}}} is not.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

inline constexpr const char* kPageTemplate = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>{{title}}</title>
<style>
:root { --ink: #1d2126; --soft: #545d68; --line: #d3d9e0; --page: #f6f7f9; --card: #ffffff; --accent: #1b5f99; --good: #1d7343; --bad: #b3261e; --open: #8a5a00;
  --good-wash: #e8f4ec; --bad-wash: #fbe9e7; --open-wash: #fbf1dc; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e9ed; --soft: #a3adb9; --line: #39414b; --page: #14171b; --card: #1c2026; --accent: #79b8ec; --good: #6fce98; --bad: #ff8a80; --open: #f0b64a;
    --good-wash: #17301f; --bad-wash: #3a1c1a; --open-wash: #33280f; }
}
@media print {
  :root { --ink: #000; --soft: #333; --line: #999; --page: #fff; --card: #fff; --accent: #1b5f99; --good: #1d7343; --bad: #b3261e; --open: #8a5a00;
    --good-wash: #e8f4ec; --bad-wash: #fbe9e7; --open-wash: #fbf1dc; }
}
* { box-sizing: border-box; }
html { scroll-padding-top: 4.5rem; }
body { margin: 0; background: var(--page); color: var(--ink); font: 16px/1.5 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
main { max-width: 74rem; margin: 0 auto; padding: 1.2rem 1rem 3rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .3rem; }
h2 { font-size: 1.4rem; line-height: 1.25; margin: 0 0 .5rem; }
h3 { font-size: 1.05rem; margin: 1.6rem 0 .5rem; }
section { margin-top: 2.2rem; padding-top: 1.6rem; border-top: 2px solid var(--line); }
p { margin: .5rem 0; max-width: 52rem; overflow-wrap: anywhere; }
a { color: var(--accent); }
a:focus-visible, summary:focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
.lead, .note { color: var(--soft); }
.note { font-size: .9rem; }
nav { position: sticky; top: 0; z-index: 1; background: var(--page); border-bottom: 1px solid var(--line); }
nav ol { max-width: 74rem; margin: 0 auto; padding: .5rem 1rem; display: flex; gap: .2rem 1.1rem; overflow-x: auto; white-space: nowrap; list-style: none; font-size: .92rem; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: .5rem; padding: .9rem; }
.card.good { border-color: var(--good); background: var(--good-wash); } .card.bad { border-color: var(--bad); background: var(--bad-wash); }
.card.open { border-color: var(--open); background: var(--open-wash); }
.notice { border-left: .45rem solid var(--soft); margin: .8rem 0; } #signoff > .notice, #verdict > .notice:first-of-type { font-size: 1.25rem; font-weight: 600; max-width: none; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(18rem, 100%), 1fr)); gap: .8rem; margin: 1rem 0; }
.figures b { display: block; font-size: 1.5rem; line-height: 1.2; color: var(--accent); }
.figures .good b { color: var(--good); } .figures .bad b { color: var(--bad); } .figures .open b { color: var(--open); }
.figures span { color: var(--soft); font-size: .9rem; display: block; }
.wide { overflow-x: auto; }
.wide:focus-visible { outline: 3px solid var(--accent); }
table { border-collapse: collapse; width: 100%; font-size: .88rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .3rem .55rem; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--soft); font-weight: 600; vertical-align: bottom; }
td.n, th.n { text-align: right; }

td.long { min-width: 9rem; overflow-wrap: anywhere; }
tr:last-child td { border-bottom: 0; }
.state { color: #fff; border-radius: 1rem; padding: .05rem .65rem; white-space: nowrap; }
.index { display: grid; grid-template-columns: repeat(auto-fit, minmax(16rem, 1fr)); gap: .8rem; margin: 1.4rem 0; }
.index a { color: inherit; text-decoration: none; } .index b { display: block; color: var(--accent); } .index span { color: var(--soft); font-size: .92rem; }
td.good { color: var(--good); } td.bad { color: var(--bad); } td.open { color: var(--open); }
td.good, td.bad, td.open { font-weight: 600; }
figure { margin: 0; position: relative; } figcaption { color: var(--soft); font-size: .9rem; margin-top: .5rem; }
svg { display: block; width: 100%; height: auto; color: var(--ink); max-width: 60rem; margin: 0 auto; }
figure .wide svg { min-width: 34rem; }
.narrow { display: none; }
.plot:focus-visible { outline: 3px solid var(--accent); }
.tools { display: flex; justify-content: flex-end; gap: .2rem; margin-top: .3rem; }
.tools button { font: inherit; line-height: 1; min-width: 1.8rem; height: 1.8rem; color: var(--ink); background: var(--card); border: 1px solid var(--line); border-radius: .3rem; cursor: pointer; }
.tools button:focus-visible { outline: 3px solid var(--accent); }
.tip { position: absolute; pointer-events: none; z-index: 2; background: var(--ink); color: var(--page); padding: .15rem .5rem; border-radius: .3rem; font-size: .85rem; white-space: nowrap; }
.zoomed svg { cursor: grab; touch-action: none; }
@media screen and (max-width: 40rem) {
  .broad { display: none; } .narrow { display: block; } .card.figure { padding: .4rem; }
}
td details { margin: 0; } td summary { font-weight: 400; padding: 0; }
details { margin: .6rem 0; } summary { cursor: pointer; font-weight: 600; padding: .3rem 0; }
pre { overflow-x: auto; margin: .6rem 0; padding: .7rem .9rem; background: var(--card); border: 1px solid var(--line); border-radius: .5rem; font-size: .87rem; }
ul, section ol { padding-left: 1.3rem; max-width: 52rem; margin: .5rem 0; } li { margin: .25rem 0; overflow-wrap: anywhere; }
footer { margin-top: 2.5rem; padding-top: 1rem; border-top: 2px solid var(--line); color: var(--soft); font-size: .88rem; }
.sign { display: flex; flex-wrap: wrap; gap: .4rem 2rem; margin: 1rem 0; }
.sign p { flex: 1 1 12rem; margin: 0; border-bottom: 1px solid var(--ink); padding-top: 2.2rem; font-size: .85rem; color: var(--soft); }
@page { size: A4; margin: 16mm 13mm 18mm; @bottom-center { content: counter(page) " / " counter(pages); font-size: 8pt; } }
@media print {
  body { font-size: 9.5pt; } main { max-width: none; padding: 0; } nav ol { display: block; white-space: normal; padding: 0; }
  nav { position: static; border: 0; } nav a { text-decoration: none; } nav a::after { content: leader(".") target-counter(attr(href), page); }
  .wide { overflow: visible; } table { font-size: 7pt; } th, td { padding: .7mm .9mm; } td.long { min-width: 0; }
  tr, figure, .card.figure, .figures .card, .notice { break-inside: avoid; } h2, h3, summary { break-after: avoid; } thead { display: table-header-group; }
  section { break-before: page; border-top: 0; } section:first-of-type { break-before: auto; } .card { padding: 1.5mm; } figure .wide svg { min-width: 0; } figure svg { max-width: 150mm; } pre { white-space: pre-wrap; }
  .folded, .tools, .tip { display: none; }
  .figures { display: flex; flex-wrap: wrap; gap: 2mm; } .figures .card { width: 31%; margin: 0 1.5mm 1.5mm 0; }
  .sign { display: table; width: 100%; table-layout: fixed; border-spacing: 6mm 0; margin: 2mm 0; } .sign p { display: table-cell; height: 11mm; padding: 0; vertical-align: bottom; }
  #signoff { margin-top: 3mm; padding-top: 0; } #signoff .figures span { font-size: 7.5pt; } #signoff .figures b { font-size: 13pt; }
  #signoff ~ nav { break-before: page; } nav + section { break-before: auto; } #signoff > .notice { font-size: 9.5pt; line-height: 1.3; margin: 1mm 0; } #signoff .figures { margin: 1mm 0; }
}
</style>
</head>
<body>
<main>
<header>
<h1>{{title}}</h1>
<p class="lead">{{lead}}</p>
</header>
<nav aria-label="Sections"><ol>{{#sections}}<li><a href="#{{id}}">{{title}}</a></li>{{/sections}}</ol></nav>
{{#has_index}}<div class="index">
{{#sections}}<a class="card" href="#{{id}}"><b>{{title}}</b><span>{{gist}}</span></a>
{{/sections}}
</div>
{{/has_index}}
{{#sections}}
<section id="{{id}}" aria-labelledby="{{id}}-title">
<h2 id="{{id}}-title">{{title}}</h2>
<p class="lead">{{gist}}</p>
{{#blocks}}
{{#is_heading}}<h3>{{text}}</h3>
{{/is_heading}}
{{#is_text}}<p>{{text}}</p>
{{/is_text}}
{{#is_stamp}}<p class="run">{{text}}</p>
{{/is_stamp}}
{{#is_notice}}<p class="card notice {{tone}}">{{text}}</p>
{{/is_notice}}
{{#is_figures}}<div class="figures">
{{#figures}}<div class="card{{#has_tone}} {{tone}}{{/has_tone}}">{{#has_question}}<span>{{question}}</span>{{/has_question}}<b>{{value}}</b><span>{{label}}</span></div>
{{/figures}}
</div>
{{/is_figures}}
{{#is_table}}{{^folded}}{{#has_title}}<h3>{{title}}</h3>{{/has_title}}{{/folded}}{{#folded}}<details class="{{fold}}"><summary>{{title}}</summary>{{/folded}}
<div class="card wide" tabindex="0" role="region" aria-label="{{label}}">
<table>
<thead><tr>{{#head}}<th scope="col"{{#n}} class="n"{{/n}}>{{text}}</th>{{/head}}</tr></thead>
<tbody>
{{#rows}}<tr>{{#cells}}<td{{#has_classes}} class="{{classes}}"{{/has_classes}}>{{#has_colour}}<span class="state" style="background:{{colour}}">{{/has_colour}}{{^has_rest}}{{text}}{{/has_rest}}{{#has_rest}}<details><summary>{{text}}</summary>{{rest}}</details>{{/has_rest}}{{#has_colour}}</span>{{/has_colour}}</td>{{/cells}}</tr>
{{/rows}}
</tbody>
</table>
</div>
{{#has_note}}<p class="note">{{note}}</p>{{/has_note}}
{{#folded}}</details>{{/folded}}
{{/is_table}}
{{#is_list}}<h3>{{title}}</h3>
<{{kind}}>
{{#items}}<li>{{#has_link}}<a href="{{link}}">{{link}}</a>: {{/has_link}}{{text}}</li>
{{/items}}
</{{kind}}>
{{/is_list}}
{{#is_signature}}<div class="sign">{{#fields}}<p>{{text}}</p>{{/fields}}</div>
{{/is_signature}}
{{#is_commands}}<pre>{{#lines}}{{text}}
{{/lines}}</pre>
{{/is_commands}}
{{#is_picture}}{{#has_title}}<h3>{{title}}</h3>{{/has_title}}
<figure class="card figure">
{{#has_svg}}<div class="plot {{#has_narrow}}broad{{/has_narrow}}{{^has_narrow}}wide{{/has_narrow}}" tabindex="0" role="img" aria-label="{{label}}">{{{svg}}}</div>{{/has_svg}}
{{#has_narrow}}<div class="plot narrow" tabindex="0" role="img" aria-label="{{label}}">{{{narrow}}}</div>
{{/has_narrow}}{{^has_svg}}<p>There is no picture: {{missing}}</p>{{/has_svg}}
<figcaption>{{caption}}{{#has_csv}} <a href="{{csv}}">The data as CSV</a>.{{/has_csv}}</figcaption>
</figure>
{{/is_picture}}
{{/blocks}}
</section>
{{/sections}}
<footer>
<p>{{footer}}</p>
{{#has_run}}<p class="run">{{run}}</p>{{/has_run}}
</footer>
</main>
{{#has_plots}}<script>
{{{script}}}</script>
{{/has_plots}}</body>
</html>
)html";

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
