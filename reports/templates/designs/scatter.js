// A scatter plot of two columns with the front of the two objectives.

const scatterOf = (host, model, on) => {
  const [base, over] = host.querySelectorAll("canvas"), EDGE = { left: 64, top: 14, right: 16, foot: 46, lane: 18 };
  let W = 0, H = 0, wide = 0, tall = 0, ratio = 1, x = 0, y = 0, px, py, scales, look, lanes = [0, 0], size = 3, stamp, under, image;

  const across = (p) => EDGE.left + lanes[0] + p * (wide - EDGE.left - lanes[0] - EDGE.right);
  const upward = (p) => tall - EDGE.foot - lanes[1] - p * (tall - EDGE.foot - lanes[1] - EDGE.top);
  const spot = (d) => [px[d], py[d]];

  // Pixels of a dot by their place in the picture from its middle: whole ones, then those of its rim
  // with their coverage in 1/256.
  const dot = (r) => {
    const whole = [], rim = [], cover = [];
    for (let j = -Math.ceil(r); j <= Math.ceil(r); j++) for (let i = -Math.ceil(r); i <= Math.ceil(r); i++) {
      const part = Math.min(1, r + 0.5 - Math.hypot(i, j));
      if (part > 0.9) whole.push(j * W + i);
      else if (part > 0.1) { rim.push(j * W + i); cover.push(Math.round(256 * part)); }
    }
    return { whole: Int32Array.from(whole), rim: Int32Array.from(rim), cover: Int32Array.from(cover) };
  };
  const dots = (out, which, colour) => {
    const { whole, rim, cover } = stamp;
    for (let d = 0; d < model.count; d++) {
      if (!which(d)) continue;
      const at = Math.round(py[d]) * W + Math.round(px[d]), c = colour(d), r = (c >> 16) & 255, g = (c >> 8) & 255, b = c & 255;
      const full = (255 << 24) | (b << 16) | (g << 8) | r;
      for (let k = 0; k < whole.length; k++) out[at + whole[k]] = full;
      for (let k = 0; k < rim.length; k++) {
        const old = out[at + rim[k]], s = cover[k], u = 256 - s;
        out[at + rim[k]] = (255 << 24) | (((s * b + u * ((old >> 16) & 255)) >> 8) << 16) | (((s * g + u * ((old >> 8) & 255)) >> 8) << 8) | ((s * r + u * (old & 255)) >> 8);
      }
    }
  };

  const lay = (chosen, now, of, colours) => {
    [x, y] = chosen;
    look = colours;
    scales = [of[x], of[y]];
    ratio = Math.min(2, devicePixelRatio || 1);
    wide = Math.max(1, host.clientWidth);  // of a page that is not laid out yet
    tall = Math.round(Math.min(420, Math.max(280, 0.75 * wide)));
    W = Math.round(wide * ratio);
    H = Math.round(tall * ratio);
    for (const canvas of [base, over]) {
      canvas.width = W;
      canvas.height = H;
      canvas.style.height = `${tall}px`;
    }
    lanes = [x, y].map((c) => (now.values[c].some((v) => !Number.isFinite(v)) ? EDGE.lane : 0));
    px = Float32Array.from(now.values[x], (v) => ratio * (Number.isFinite(v) ? across(scales[0].at(v)) : EDGE.left + 7));
    py = Float32Array.from(now.values[y], (v) => ratio * (Number.isFinite(v) ? upward(scales[1].at(v)) : tall - EDGE.foot - 7));
    const n = model.count;
    size = n < 300 ? 4.5 : n < 3000 ? 3 : n < 30000 ? 2 : 1.2;
    stamp = dot(size * ratio);
    image = new ImageData(W, H);
    under = new Uint32Array(W * H);
    const [pr, pg, pb] = look.paper, [fr, fg, fb] = look.faint, faint = (fr << 16) | (fg << 8) | fb;
    under.fill((255 << 24) | (pb << 16) | (pg << 8) | pr);
    dots(under, (d) => !now.failed[d], () => faint);
  };

  const draw = (mask, now, front) => {
    const flat = base.getContext("2d"), out = new Uint32Array(image.data.buffer);
    out.set(under);
    dots(out, (d) => mask[d] && !now.failed[d], (d) => look.of[d]);
    flat.putImageData(image, 0, 0);
    flat.save();
    flat.scale(ratio, ratio);
    crosses(flat, mask, now);
    furniture(flat);
    flat.restore();
    edge(flat, front);
  };

  const crosses = (flat, mask, now) => {
    const path = new Path2D();
    for (let d = 0; d < model.count; d++) {
      if (!mask[d] || !now.failed[d]) continue;
      const [i, j] = spot(d).map((p) => p / ratio);
      path.moveTo(i - 3.5, j - 3.5);
      path.lineTo(i + 3.5, j + 3.5);
      path.moveTo(i - 3.5, j + 3.5);
      path.lineTo(i + 3.5, j - 3.5);
    }
    flat.strokeStyle = look.hot;
    flat.lineWidth = 1.4;
    flat.stroke(path);
  };

  const furniture = (flat) => {
    const foot = tall - EDGE.foot, title = (c) => titled(model.columns[c]);
    const line = (colour, dash, ...ends) => {
      flat.strokeStyle = colour;
      flat.setLineDash(dash);
      flat.lineWidth = 1;
      flat.beginPath();
      flat.moveTo(ends[0], ends[1]);
      flat.lineTo(ends[2], ends[3]);
      flat.stroke();
      flat.setLineDash([]);
    };
    flat.font = "11px system-ui, sans-serif";
    flat.fillStyle = look.quiet;
    line(look.rule, [], EDGE.left, foot, wide - EDGE.right, foot);
    line(look.rule, [], EDGE.left, EDGE.top, EDGE.left, foot);
    flat.textAlign = "center";
    let free = -Infinity;
    for (const [p, text] of scales[0].ticks) {
      const at = across(p), half = 0.5 * flat.measureText(text).width;
      line(look.rule, [], at, foot, at, foot + 4);
      if (at - half > free) { flat.fillText(text, at, foot + 16, 90); free = at + half + 6; }
    }
    flat.textAlign = "right";
    for (const [p, text] of scales[1].ticks) {
      line(look.rule, [], EDGE.left - 4, upward(p), EDGE.left, upward(p));
      flat.fillText(text, EDGE.left - 7, upward(p) + 4, EDGE.left - 22);
    }
    flat.textAlign = "left";
    if (lanes[0]) line(look.rule, [2, 3], EDGE.left + lanes[0] - 3, EDGE.top, EDGE.left + lanes[0] - 3, foot);
    if (lanes[1]) line(look.rule, [2, 3], EDGE.left, foot - lanes[1] + 3, wide - EDGE.right, foot - lanes[1] + 3);
    if (lanes[1]) { flat.textAlign = "right"; flat.fillText("no value", wide - EDGE.right, foot - 3); }
    flat.fillStyle = look.ink;
    flat.font = "12px system-ui, sans-serif";
    flat.textAlign = "center";
    flat.fillText(`${title(x)}${scales[0].log ? ", logarithmic" : ""}`, 0.5 * (EDGE.left + wide - EDGE.right), tall - 8, wide - EDGE.left - EDGE.right);
    flat.save();
    flat.translate(13, 0.5 * (EDGE.top + foot));
    flat.rotate(-Math.PI / 2);
    flat.fillText(`${title(y)}${scales[1].log ? ", logarithmic" : ""}`, 0, 0, foot - EDGE.top);
    flat.restore();
    const required = model.byKey.safety_factor?.index;
    if (model.required === null) return;
    const say = (i, j) => {
      const text = `required ${short(model.required, 4)}`;
      flat.textAlign = "left";
      flat.lineWidth = 4;
      flat.lineJoin = "round";
      flat.strokeStyle = look.halo;
      flat.strokeText(text, i, j);
      flat.fillStyle = look.hot;
      flat.fillText(text, i, j);
    };
    if (x === required) {
      const at = across(scales[0].at(model.required));
      line(look.hot, [6, 3], at, EDGE.top, at, foot);
      say(at + 4, EDGE.top + 10);
    }
    if (y === required) {
      const at = upward(scales[1].at(model.required));
      line(look.hot, [6, 3], EDGE.left, at, wide - EDGE.right, at);
      say(EDGE.left + lanes[0] + 4, at - 4);
    }
  };

  // Rings on the front; its steps where its objectives are the axes.
  const edge = (flat, { designs, axes, signs }) => {
    const turned = axes[0] === y && axes[1] === x, shown = turned || (axes[0] === x && axes[1] === y);
    flat.strokeStyle = look.ink;
    flat.lineWidth = 1.6 * ratio;
    flat.beginPath();
    // Between two designs of the front the corner is the one that is worse in both objectives.
    const corner = (a, b) => {
      const worse = (p, q, c) => (((signs[axes.indexOf(c)] > 0) === (c === x)) ? Math.max(p, q) : Math.min(p, q));
      return [worse(px[a], px[b], x), worse(py[a], py[b], y)];
    };
    designs.forEach((d, k) => {
      if (!shown) return;
      if (!k) flat.moveTo(...spot(d));
      else { flat.lineTo(...corner(designs[k - 1], d)); flat.lineTo(...spot(d)); }
    });
    flat.stroke();
    flat.lineWidth = 1.2 * ratio;
    for (const d of designs) {
      flat.beginPath();
      flat.arc(...spot(d), (size + 2) * ratio, 0, 7);
      flat.stroke();
    }
  };

  // Over the dots: the rectangle of the ranges of both columns, and the design shown.
  const mark = (ranges, shown) => {
    const flat = over.getContext("2d"), rx = ranges.get(x), ry = ranges.get(y);
    flat.clearRect(0, 0, W, H);
    const clip = (p) => Math.min(1, Math.max(0, p));
    if (rx || ry) {
      const [a, b] = rx ? rx.map((v) => across(clip(scales[0].at(v)))) : [across(0), across(1)];
      const [c, d] = ry ? ry.map((v) => upward(clip(scales[1].at(v)))) : [upward(0), upward(1)];
      flat.fillStyle = look.brush;
      flat.fillRect(a * ratio, d * ratio, (b - a) * ratio, (c - d) * ratio);
      flat.strokeStyle = look.accent;
      flat.lineWidth = ratio;
      flat.strokeRect(a * ratio, d * ratio, (b - a) * ratio, (c - d) * ratio);
    }
    if (shown < 0) return;
    for (const [colour, width] of [[look.halo, 5], [look.ink, 2]]) {
      flat.strokeStyle = colour;
      flat.lineWidth = width * ratio;
      flat.beginPath();
      flat.arc(...spot(shown), (size + 4) * ratio, 0, 7);
      flat.stroke();
    }
  };

  // The selected design closest to a place, within 16 pixels; -1 for none.
  const nearest = (mask, i, j) => {
    let found = -1, least = (16 * ratio) ** 2;
    for (let d = 0; d < mask.length; d++) {
      if (!mask[d]) continue;
      const away = (px[d] - i * ratio) ** 2 + (py[d] - j * ratio) ** 2;
      if (away < least) { least = away; found = d; }
    }
    return found;
  };

  let drag = null;
  const place = (event) => {
    const box = over.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const parts = ([i, j]) => [(i - across(0)) / (across(1) - across(0)), (j - upward(0)) / (upward(1) - upward(0))].map((p) => Math.min(1, Math.max(0, p)));
  over.addEventListener("pointerdown", (event) => {
    if (event.button) return;
    drag = { from: place(event), moved: false };
    over.setPointerCapture(event.pointerId);
  });
  over.addEventListener("pointermove", (event) => {
    const to = place(event);
    if (!drag) return on.point(...to);
    if (Math.hypot(to[0] - drag.from[0], to[1] - drag.from[1]) > 4) drag.moved = true;
    if (!drag.moved) return;
    const a = parts(drag.from), b = parts(to);
    on.brush(x, [Math.min(a[0], b[0]), Math.max(a[0], b[0])].map(scales[0].back), true);
    if (x !== y) on.brush(y, [Math.min(a[1], b[1]), Math.max(a[1], b[1])].map(scales[1].back), true);
  });
  over.addEventListener("pointerup", () => {
    if (drag?.moved) on.release();
    else if (drag) on.keep();
    drag = null;
  });
  over.addEventListener("pointercancel", () => { if (drag) on.release(); drag = null; });
  over.addEventListener("pointerleave", () => on.leave());

  // Selected designs from left to right, for the keyboard.
  const inOrder = (mask) => {
    const found = [];
    for (let d = 0; d < mask.length; d++) if (mask[d]) found.push(d);
    return found.sort((a, b) => px[a] - px[b] || py[a] - py[b]);
  };

  return { lay, draw, mark, nearest, inOrder };
};
