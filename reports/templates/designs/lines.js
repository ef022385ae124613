// Parallel coordinates. Lines are counted per pixel, so that a brush costs only the lines that enter
// or leave the selection, and a pixel's colour is the mean of the lines through it.

const LEAST = 92; // pixels between two axes
const TALL = 300, LANE = 24, SIDE = 56; // height of the axes, of the lane of what has no value, margins
const SHARE = 2 ** 26; // two numbers in one: sums of 8 bits over fewer than 2^18 lines

const linesOf = (host, model, on) => {
  const [base, over] = host.querySelectorAll("canvas"), svg = host.querySelector("svg"), names = host.querySelector(".names");
  let axes = [], xs = [], ys = [], scales = [], W = 0, H = 0, ratio = 1, tall = TALL, image, every, counts, rest, drawn, look;

  const toPixel = (p) => (Number.isFinite(p) ? (1 - p) * (TALL - 1) : TALL + LANE / 2);

  // A design's line, added or taken away.
  const stroke = (d, sign) => {
    const c = look.of[d], first = sign * (SHARE + ((c >> 16) & 255)), second = sign * (((c >> 8) & 255) * SHARE + (c & 255));
    for (let k = 0; k + 1 < xs.length; k++) {
      const y0 = ys[k][d], dx = xs[k + 1] - xs[k], dy = ys[k + 1][d] - y0, n = Math.max(dx, Math.abs(dy));
      const sx = dx / n, sy = dy / n;
      let x = xs[k] + 0.5, y = y0 + 0.5;
      for (let i = 0; i < n; i++, x += sx, y += sy) {
        const at = (y | 0) * W + (x | 0);
        counts[at] += first;
        rest[at] += second;
      }
    }
  };
  const faint = (d) => {
    for (let k = 0; k + 1 < xs.length; k++) {
      const y0 = ys[k][d], dx = xs[k + 1] - xs[k], dy = ys[k + 1][d] - y0, n = Math.max(dx, Math.abs(dy));
      const sx = dx / n, sy = dy / n;
      let x = xs[k] + 0.5, y = y0 + 0.5;
      for (let i = 0; i < n; i++, x += sx, y += sy) every[(y | 0) * W + (x | 0)] = 1;
    }
  };

  // Denser is stronger, but a single line can always be seen.
  const strengths = (lines) => {
    const one = 1 - 0.5 ** (1 / Math.max(lines / H, 0.2));
    return Float64Array.from({ length: 4096 }, (_, c) => (c ? 0.3 + 0.7 * (1 - (1 - one) ** c) : 0));
  };

  const paint = (lines) => {
    const out = new Uint32Array(image.data.buffer), strength = strengths(lines), [pr, pg, pb] = look.paper, [fr, fg, fb] = look.faint;
    const empty = (255 << 24) | (pb << 16) | (pg << 8) | pr, grey = (255 << 24) | (fb << 16) | (fg << 8) | fr;
    for (let i = 0; i < out.length; i++) {
      const v = counts[i];
      if (!v) { out[i] = every[i] ? grey : empty; continue; }
      const n = (v / SHARE) | 0, w = rest[i], g = (w / SHARE) | 0, s = strength[n < 4095 ? n : 4095], t = s / n, u = 1 - s;
      const under = every[i] ? look.faint : look.paper;
      out[i] = (255 << 24) | ((u * under[2] + t * (w - g * SHARE)) << 16) | ((u * under[1] + t * g) << 8) | (u * under[0] + t * (v - n * SHARE));
    }
    base.getContext("2d").putImageData(image, 0, 0);
  };

  // Draws the selection; whole: not from what was drawn before.
  const update = (mask, lines, whole = false) => {
    let changed = 0;
    if (!whole) for (let d = 0; d < mask.length; d++) changed += mask[d] ^ drawn[d];
    const anew = whole || changed > lines;
    if (anew) { counts.fill(0); rest.fill(0); drawn.fill(0); }
    if (anew || changed) for (let d = 0; d < mask.length; d++) if (mask[d] !== drawn[d]) stroke(d, mask[d] ? 1 : -1);
    drawn.set(mask);
    if (anew || changed) paint(lines);
  };

  // Lays everything out: chosen columns, their values and scales, colours.
  const lay = (chosen, now, of, colours) => {
    axes = chosen;
    look = colours;
    ratio = Math.min(2, devicePixelRatio || 1);
    scales = axes.map((c) => of[c]);
    const wide = Math.max(host.clientWidth, 2 * SIDE + LEAST * (axes.length - 1)), lacking = axes.some((c) => now.values[c].some((v) => !Number.isFinite(v)));
    tall = TALL + (lacking ? LANE : 0);
    W = Math.round(wide * ratio);
    H = Math.round(tall * ratio);
    const step = axes.length > 1 ? (wide - 2 * SIDE) / (axes.length - 1) : 0;
    xs = axes.map((_, k) => Math.round((SIDE + k * step) * ratio));
    ys = axes.map((c, k) => Int32Array.from(now.values[c], (v) => Math.round(toPixel(scales[k].at(v)) * ratio)));
    if (axes.length === 1) { xs.push(xs[0] + Math.round(LEAST * ratio)); ys.push(ys[0]); }
    for (const canvas of [base, over]) {
      canvas.width = W;
      canvas.height = H;
      canvas.style.width = `${wide}px`;
      canvas.style.height = `${tall}px`;
    }
    image = new ImageData(W, H);
    every = new Uint8Array(W * H);
    counts = new Float64Array(W * H);
    rest = new Float64Array(W * H);
    drawn = new Uint8Array(model.count);
    for (let d = 0; d < model.count; d++) faint(d);
    furniture(wide, step, lacking);
  };

  const make = (name, attributes, text) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    return made;
  };
  const furniture = (wide, step, lacking) => {
    svg.setAttribute("width", wide);
    svg.setAttribute("height", tall);
    names.style.width = `${wide}px`;
    names.replaceChildren(...axes.map((c, k) => {
      const name = document.createElement("div");
      name.textContent = breakable(titled(model.columns[c]));
      name.style.left = `${SIDE + k * step}px`;
      name.style.width = `${Math.min(2 * SIDE, Math.max(step, LEAST)) - 6}px`;
      return name;
    }));
    svg.replaceChildren(...axes.map((c, k) => {
      const group = make("g", { transform: `translate(${SIDE + k * step} 0)`, class: "axis", "data-axis": c });
      group.append(make("line", { y1: 0, y2: TALL, class: "rod" }));
      for (const [p, text] of scales[k].ticks) {
        const y = toPixel(p);
        group.append(make("line", { x1: -4, x2: 0, y1: y, y2: y, class: "rod" }), make("text", { x: -6, y: Math.min(TALL - 2, Math.max(9, y + 4)) }, text.length > 14 ? `${text.slice(0, 13)}…` : text));
      }
      if (model.columns[c].key === "safety_factor" && model.required !== null) {
        const y = toPixel(scales[k].at(model.required));
        group.append(make("line", { x1: -14, x2: 14, y1: y, y2: y, class: "required" }), make("text", { x: 16, y: y + 4, class: "required" }, short(model.required, 4)));
      }
      if (lacking && k === 0) group.append(make("text", { x: -SIDE + 2, y: TALL + LANE / 2 + 4, class: "lane" }, "no value"));
      group.append(make("rect", { x: -9, width: 18, y: 0, height: 0, class: "brush" }), make("rect", { x: -16, width: 32, y: 0, height: TALL, class: "grab" }));
      return group;
    }));
  };

  const brushes = (ranges) => axes.forEach((c, k) => {
    const rect = svg.children[k].querySelector(".brush"), range = ranges.get(c);
    const [top, foot] = range ? [scales[k].at(range[1]), scales[k].at(range[0])].map((p) => Math.min(TALL, Math.max(0, toPixel(p)))) : [0, 0];
    rect.setAttribute("y", top);
    rect.setAttribute("height", range ? Math.max(2, foot - top) : 0);
  });

  // Marks over the lines: failed designs at their parameters, the design shown.
  const mark = (mask, now, shown) => {
    const flat = over.getContext("2d");
    flat.clearRect(0, 0, W, H);
    flat.fillStyle = look.hot;
    flat.globalAlpha = 0.6;
    for (let d = 0; d < model.count; d++) {
      if (!now.failed[d] || !mask[d]) continue;
      axes.forEach((c, k) => { if (model.columns[c].of === "design") flat.fillRect(xs[k], ys[k][d] - 0.5 * ratio, 8 * ratio, ratio); });
    }
    flat.globalAlpha = 1;
    if (shown < 0) return;
    const path = new Path2D();
    xs.forEach((x, k) => path[k ? "lineTo" : "moveTo"](x, ys[k][shown]));
    flat.lineJoin = "round";
    for (const [colour, wide] of [[look.halo, 6], [look.ink, 2.5]]) {
      flat.strokeStyle = colour;
      flat.lineWidth = wide * ratio;
      flat.stroke(path);
    }
  };

  // The selected design whose line is the closest to a place, within 10 pixels; -1 for none.
  const nearest = (mask, px, py) => {
    const x = px * ratio, y = py * ratio;
    let k = 0, found = -1, least = 10 * ratio;
    while (k + 2 < xs.length && x > xs[k + 1]) k++;
    if (xs.length < 2 || x < xs[0] || x > xs[k + 1]) return -1;
    const t = (x - xs[k]) / (xs[k + 1] - xs[k]), a = ys[k], b = ys[k + 1];
    for (let d = 0; d < mask.length; d++) {
      if (!mask[d]) continue;
      const away = Math.abs(a[d] + t * (b[d] - a[d]) - y);
      if (away < least) { least = away; found = d; }
    }
    return found;
  };

  // Dragging along an axis makes a range, or moves or resizes the one there; a click removes it.
  let drag = null;
  svg.addEventListener("pointerdown", (event) => {
    const group = event.target.closest(".grab")?.parentNode;
    if (!group || event.button) return;
    const c = Number(group.dataset.axis), scale = scales[axes.indexOf(c)], range = on.range(c);
    const place = (e) => 1 - (e.clientY - svg.getBoundingClientRect().top) / (TALL - 1);
    const p = place(event), ends = range && range.map(scale.at), near = 7 / TALL;
    const grip = ends ? ends.findIndex((end) => Math.abs(end - p) < near) : -1;
    const within = ends && grip < 0 && p > ends[0] && p < ends[1];
    const fixed = grip >= 0 ? ends[1 - grip] : p;
    drag = { moved: false, to: (e) => {
      const q = Math.min(1, Math.max(0, place(e)));
      if (Math.abs(q - p) * TALL > 3) drag.moved = true;
      if (!drag.moved) return;
      const both = within ? ends.map((end) => end + q - p) : [Math.min(fixed, q), Math.max(fixed, q)];
      on.brush(c, both.map(scale.back), true);
    }, end: () => (drag.moved ? on.release() : on.brush(c, null)) };
    svg.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  svg.addEventListener("pointermove", (event) => {
    if (drag) return drag.to(event);
    const box = svg.getBoundingClientRect();
    on.point(event.clientX - box.left, event.clientY - box.top);
  });
  svg.addEventListener("pointerup", () => { drag?.end(); drag = null; });
  svg.addEventListener("pointercancel", () => { if (drag) on.release(); drag = null; });
  svg.addEventListener("pointerleave", () => on.leave());
  svg.addEventListener("click", (event) => { if (!event.target.closest(".grab")) on.keep(); });

  return { lay, update, brushes, mark, nearest };
};
