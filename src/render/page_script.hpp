/// Zoom and readout of the charts (private to src/render). A page shows everything without it: where no script may run,
/// the pictures stand still.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

inline constexpr const char* kPageScript = R"js("use strict";
for (const figure of document.querySelectorAll("figure")) {
  const plots = [...figure.querySelectorAll(".plot")].map(box => {
    const svg = box.querySelector("svg"), b = svg.viewBox.baseVal, whole = [b.x, b.y, b.width, b.height];
    return {box, svg, whole, view: whole, axes: JSON.parse(svg.dataset.axes || "[]"), marks: null};
  });
  if (!plots.length) continue;
  const limited = (v, low, high) => Math.min(Math.max(v, low), high);
  const show = (p, x, y, w) => {
    const [X, Y, W, H] = p.whole, h = w * H / W;
    p.view = [limited(x, X, X + W - w), limited(y, Y, Y + H - h), w, h];
    p.svg.setAttribute("viewBox", p.view.join(" "));
    p.box.classList.toggle("zoomed", w < W);
  };
  const zoom = (p, by, x = p.view[0] + p.view[2] / 2, y = p.view[1] + p.view[3] / 2) => {
    const w = limited(p.view[2] / by, p.whole[2] / 16, p.whole[2]), k = w / p.view[2];
    show(p, x - (x - p.view[0]) * k, y - (y - p.view[1]) * k, w);
  };
  const place = (p, e) => {
    const r = p.svg.getBoundingClientRect();
    return [p.view[0] + (e.clientX - r.left) / r.width * p.view[2], p.view[1] + (e.clientY - r.top) / r.height * p.view[3]];
  };
  const value = ([from, to, low, high, log], at) => {
    const t = (at - from) / (to - from);
    return +(log ? low * Math.pow(high / low, t) : low + t * (high - low)).toPrecision(4);
  };
  const tip = figure.appendChild(document.createElement("div"));
  tip.className = "tip";
  tip.hidden = true;
  const tell = (p, e) => {
    const [x, y] = place(p, e), reach = 14 * p.view[2] / p.svg.getBoundingClientRect().width;
    const inside = (a, x, y) => x >= a.x[0] && x <= a.x[1] && y <= a.y[0] && y >= a.y[1];
    const axes = p.axes.find(a => inside(a, x, y));
    tip.hidden = !axes;
    if (!axes) return;
    p.marks = p.marks || [...p.svg.querySelectorAll(".m")].map(m => m.getAttribute("transform").match(/-?[\d.]+/g).slice(0, 2).map(Number));
    let near = [x, y], best = reach;
    for (const m of p.marks) {
      const far = Math.hypot(m[0] - x, m[1] - y);
      if (far < best && inside(axes, m[0], m[1])) [near, best] = [m, far];
    }
    tip.textContent = `${axes.x[5]} ${value(axes.x, near[0])}; ${axes.y[5]} ${value(axes.y, near[1])}`;
    const f = figure.getBoundingClientRect();
    tip.style.left = limited(e.clientX - f.left + 12, 0, Math.max(0, f.width - tip.offsetWidth)) + "px";
    tip.style.top = Math.max(0, e.clientY - f.top - 34) + "px";
  };
  const tools = figure.insertBefore(document.createElement("div"), figure.querySelector("figcaption"));
  tools.className = "tools";
  const seen = () => plots.find(p => p.box.offsetParent) || plots[0];
  for (const [sign, words, act] of [["+", "Zoom in", () => zoom(seen(), 1.6)], ["−", "Zoom out", () => zoom(seen(), 1 / 1.6)]]) {
    const button = tools.appendChild(document.createElement("button"));
    button.type = "button";
    button.textContent = sign;
    button.setAttribute("aria-label", words);
    button.onclick = act;
  }
  for (const p of plots) {
    let held = null;
    p.svg.addEventListener("pointermove", e => {
      if (held) {
        const [x, y] = place(p, e);
        show(p, p.view[0] + held[0] - x, p.view[1] + held[1] - y, p.view[2]);
      }
      tell(p, e);
    });
    p.svg.addEventListener("pointerdown", e => {
      tell(p, e);
      if (p.view[2] < p.whole[2]) {
        held = place(p, e);
        p.svg.setPointerCapture(e.pointerId);
      }
    });
    for (const end of ["pointerup", "pointercancel"]) p.svg.addEventListener(end, () => { held = null; });
    p.svg.addEventListener("pointerleave", () => { tip.hidden = true; });
    p.svg.addEventListener("wheel", e => {
      if (!e.ctrlKey) return;
      e.preventDefault();
      zoom(p, e.deltaY < 0 ? 1.25 : 0.8, ...place(p, e));
    }, {passive: false});
    p.svg.addEventListener("dblclick", e => p.view[2] < p.whole[2] ? zoom(p, 1e-3) : zoom(p, 3, ...place(p, e)));
    p.box.addEventListener("keydown", e => {
      const [x, y, w, h] = p.view, step = w / 8;
      const move = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]}[e.key];
      if (e.key === "+") zoom(p, 1.6);
      else if (e.key === "-") zoom(p, 1 / 1.6);
      else if (e.key === "0") zoom(p, 1e-3);
      else if (move && w < p.whole[2]) show(p, x + move[0], y + move[1], w);
      else return;
      e.preventDefault();
    });
  }
}
const folded = [...document.querySelectorAll("details:not(.folded)")];
addEventListener("beforeprint", () => folded.forEach(d => { d.dataset.was = d.open ? "1" : ""; d.open = true; }));
addEventListener("afterprint", () => folded.forEach(d => { d.open = d.dataset.was === "1"; }));
)js";

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
