"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const all = (selector) => [...document.querySelectorAll(selector)];
  const one = (selector) => document.querySelector(selector);
  const parts = {
    joints: all("[data-joint]"), links: all("[data-link]"), slides: all("[data-slide]"),
    centres: all("[data-centre]"), arrows: all("[data-arrow]"), rows: all("[data-row]"),
    curves: all("[data-curve]"), strips: all("[data-strip]"), cursors: all(".cursor"),
    positions: all("[data-position]"), forces: all("output[data-force]"),
    applied: all("[data-applied]"), levers: all("[data-lever]"), sizes: all("[data-size-of]"),
    names: all("[data-between]"), pitch: all("[data-pitch]"),
    springs: all("[data-spring]"),
  };
  const space = data.space && inSpace(data), dim = space ? 3 : 2; // coordinates of a point
  const axesOf = space ? ["fx", "fy", "fz"] : ["fx", "fy"];
  const time = data.time, last = time.length - 1, span = time[last] - time[0];
  const seek = one("#seek"), play = one("#play"), callout = one("#callout"), key = one("#key");
  const LEFT = 70, RIGHT = 946; // of the strips' curves
  const HEAD = 10; // length of an arrow's head
  const PAUSE = 600; // ms at the end before it starts again
  let now = time[0], playing = false, direction = 1, before = 0, rest = 0, request = 0;
  let root = false; // square-root arrows
  let pinned = null, pointed = null;

  // --- numbers -------------------------------------------------------------------------------

  const written = (value, fixed) => {
    if (value === null || !Number.isFinite(value)) return "–";
    const d = fixed.decimals;
    let text = (value / fixed.factor).toLocaleString("en-US", { minimumFractionDigits: d, maximumFractionDigits: d });
    if (/^-[0.,]*$/.test(text)) text = text.slice(1);
    return text.replace("-", "−");
  };
  const plain = (value) => written(value, { factor: 1, decimals: Math.min(8, Math.max(0, 3 - Math.floor(Math.log10(Math.abs(value) || 1)))) });
  const decimals = span > 0 ? Math.min(9, Math.max(0, 3 - Math.floor(Math.log10(span)))) : 3;

  // The frame before the current time, and the fraction of the interval to the next.
  const frame = () => {
    let low = 0, high = last;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (time[middle] <= now) low = middle; else high = middle;
    }
    const step = time[high] - time[low];
    return { i: low, u: step > 0 ? Math.min(1, Math.max(0, (now - time[low]) / step)) : 0 };
  };
  const at = (values, { i, u }, width = 1, k = 0) => {
    const a = values[i * width + k];
    if (u === 0) return a;
    const b = values[Math.min(i + 1, last) * width + k];
    return a === null || b === null ? null : a + (b - a) * u;
  };
  // A point of the data, of several in a row that of number k, and its place on the picture.
  const point3 = (values, f, count = 1, k = 0) => Array.from({ length: dim }, (_, i) => at(values, f, dim * count, dim * k + i));
  const seen = (p) => (space ? space.seen(p) : p);
  const spot = (values, f, count, k) => seen(point3(values, f, count, k));
  // A force: its components, and its direction on the picture, as long as it is seen.
  const forceOf = (c, f) => axesOf.map((axis) => at(c[axis], f));
  const aimed = (force) => (space ? space.aimed(force) : [force[0], -force[1]]);
  const apart = (p, q) => Math.hypot(...p.map((x, i) => x - q[i]));
  const nearest = () => { const { i, u } = frame(); return u > 0.5 ? i + 1 : i; };

  // --- picture -------------------------------------------------------------------------------

  const place = (x, y) => `translate(${x.toFixed(2)} ${y.toFixed(2)})`;
  const line = (points, closed) => "M" + points.map((p) => p[0].toFixed(2) + "," + p[1].toFixed(2)).join(" ") + (closed ? "Z" : "");

  // As reports/format/drawing/zigzag.py.
  const TURNS = 15, STRAIGHT = 0.15, HALF_WIDTH = 7;
  const zigzag = ([ax, ay], [bx, by]) => {
    const [x, y] = [bx - ax, by - ay], whole = Math.hypot(x, y), width = Math.min(HALF_WIDTH, whole / 4) / (whole || 1);
    const turns = Array.from({ length: TURNS }, (_, k) => [STRAIGHT + ((1 - 2 * STRAIGHT) * (k + 0.5)) / TURNS, k % 2 ? -width : width]);
    return [[0, 0], [STRAIGHT, 0], ...turns, [1 - STRAIGHT, 0], [1, 0]].map(([s, w]) => [ax + s * x - w * y, ay + s * y + w * x]);
  };

  const stretch = (arrow, length) => {
    const head = Math.min(HEAD, 0.6 * length);
    arrow.setAttribute("visibility", length < 1 ? "hidden" : "visible");
    arrow.querySelector("line").setAttribute("x2", (length - 0.8 * head).toFixed(2));
    arrow.querySelector("path").setAttribute("transform", `translate(${length.toFixed(2)}) scale(${(head / HEAD).toFixed(3)})`);
  };
  const length = (force, largest = data.arrow.largest) => {
    const part = largest > 0 ? force / largest : 0;
    return data.arrow.longest * (root ? Math.sqrt(part) : part);
  };

  // The length of the arrow of a force on the picture.
  const foreshortened = (force, aim, largest) => {
    const size = Math.hypot(...force);
    return size > 0 ? (length(size, largest) * Math.hypot(...aim)) / size : 0;
  };

  const draw = () => {
    const f = frame();
    const joints = data.at.map((values) => spot(values, f)), centres = data.centres.map((values) => spot(values, f));
    parts.joints.forEach((g, j) => g.setAttribute("transform", place(...joints[j])));
    parts.links.forEach((g, b) => {
      const points = data.links[b].map((j) => joints[j]);
      if (space?.stems.has(b)) points.push(centres[b]);
      if (points.length < 2) return;
      const d = line(points, points.length > 2);
      for (const path of g.children) path.setAttribute("d", d);
    });
    parts.names.forEach((text) => {
      const [p, q] = text.dataset.between.split(" ").map((j) => joints[j]);
      text.setAttribute("transform", place((p[0] + q[0]) / 2, (p[1] + q[1]) / 2));
    });
    parts.pitch.forEach((g, n) => {
      const [[ax, ay], [bx, by]] = [0, 1].map((k) => spot(data.pitch[n], f, 2, k));
      g.children[0].setAttribute("d", line([[ax, ay], [bx, by]]));
      if (g.children[1]) g.children[1].setAttribute("transform", place(ax, ay));
    });
    parts.springs.forEach((path, n) => path.setAttribute("d", line(zigzag(...[0, 1].map((k) => spot(data.springs[n], f, 2, k))))));
    parts.slides.forEach((g, s) => {
      const slide = data.slides[s];
      const ends = [0, 1].map((k) => point3(slide.ends, f, 2, k)), [[ax, ay], [bx, by]] = ends.map(seen);
      if (slide.rail) {
        g.firstElementChild.setAttribute("transform", `${place(bx, by)} rotate(${slide.angle})`);
        return;
      }
      const whole = apart(...ends), part = whole > 0 ? Math.min(1, slide.cylinder / whole) : 0;
      const [rod, rim, core] = g.children;
      rod.setAttribute("d", line([[ax, ay], [bx, by]]));
      const barrel = line([[ax, ay], [ax + part * (bx - ax), ay + part * (by - ay)]]);
      rim.setAttribute("d", barrel);
      core.setAttribute("d", barrel);
    });
    parts.centres.forEach((g, b) => g.setAttribute("transform", place(...centres[b])));
    data.connections.forEach((c, n) => {
      const force = forceOf(c, f), [u, v] = aimed(force), angle = (Math.atan2(v, u) * 180) / Math.PI;
      parts.arrows[n].setAttribute("transform", `${place(...joints[c.joint])} rotate(${angle.toFixed(2)})`);
      stretch(parts.arrows[n], foreshortened(force, [u, v]));
      const cells = parts.rows[n].children;
      [...force, at(c.f, f)].forEach((value, k) => { cells[2 + k].textContent = written(value, data.fixed.force); });
    });
    [...data.applied, ...data.couples].forEach((a, n) => {
      const couple = n >= data.applied.length, fixed = couple ? data.fixed.couple : data.fixed.force;
      // It ends just before its point; its size is written beyond its tail.
      const [x, y] = spot(a.at, f), components = forceOf(a, f), aim = aimed(components);
      const force = Math.hypot(...components), long = foreshortened(components, aim, couple ? data.arrow.couple : data.arrow.largest), back = long + data.arrow.gap, size = parts.sizes[n];
      const [u, v] = force > 0 ? aim.map((c) => c / (Math.hypot(...aim) || 1)) : [0, 0];
      const angle = (Math.atan2(v, u) * 180) / Math.PI;
      if (Number.isInteger(a.lever)) parts.levers[n].setAttribute("d", line([joints[a.lever], [x, y]]));
      parts.applied[n].setAttribute("transform", `${place(x - back * u, y - back * v)} rotate(${angle.toFixed(2)})`);
      stretch(parts.applied[n], long);
      size.setAttribute("transform", place(x - (back + 12) * u, y - (back + 12) * v + 4));
      size.style.textAnchor = u > 0.4 ? "end" : u < -0.4 ? "start" : "middle";
      size.textContent = force > 0 ? `${written(force, fixed)} ${fixed.unit}` : "";
    });
    data.drives.forEach((d, n) => {
      if (!parts.positions[n]) return;
      parts.positions[n].textContent = written(at(d.position, f), data.fixed.drives[n][0]);
      parts.forces[n].textContent = written(at(d.force, f), data.fixed.drives[n][1]);
    });
    space?.draw(f, joints, at);
    const x = LEFT + (span > 0 ? (now - time[0]) / span : 0) * (RIGHT - LEFT);
    for (const cursor of parts.cursors) { cursor.setAttribute("x1", x.toFixed(1)); cursor.setAttribute("x2", x.toFixed(1)); }
    if (seek) {
      const text = written(now, { factor: 1, decimals });
      one("#time").textContent = text;
      seek.value = nearest();
      seek.setAttribute("aria-valuetext", `${text} ${data.units.time}`);
    }
    tell(f, joints);
  };

  // --- the selected joint ----------------------------------------------------------------------

  const chosen = () => pointed ?? pinned;

  const element = (name, text) => { const e = document.createElement(name); e.textContent = text; return e; };

  // The coordinates of a point of the data, in the study's unit of length.
  const placeOf = (p) => {
    const { left, top, scale } = data.places;
    const world = space ? p.map((c, i) => data.space.middle[i] + c / scale) : [(p[0] - left) / scale, (top - p[1]) / scale];
    return world.map((c, i) => `${"xyz"[i]} ${plain(c)}`).join(", ");
  };

  const tell = (f, joints) => {
    const j = chosen();
    callout.hidden = j === null;
    if (j === null) return;
    const [x] = joints[j];
    const box = element("div", "");
    box.append(element("b", data.joints[j]), element("small", `${placeOf(point3(data.at[j], f))} ${data.units.length}`));
    const table = element("table", "");
    data.connections.forEach((c, n) => {
      if (c.joint !== j) return;
      const row = table.insertRow();
      row.className = parts.rows[n].className.replace("hot", "");
      const head = element("th", "");
      head.append(element("i", ""), c.body ? `${c.name}, ${c.body}` : c.name);
      row.append(head, element("td", written(at(c.f, f), data.fixed.force)));
      const angle = (Math.atan2(at(c.fy, f), at(c.fx, f)) * 180) / Math.PI;
      if (!space) row.append(element("td", `${written(angle, { factor: 1, decimals: 0 })}°`));
      for (const cell of [...row.cells].slice(1)) cell.className = "n";
    });
    if (table.rows.length) box.append(table, element("small", `force on the pin${space ? "" : "; angle from the x axis"}`));
    callout.replaceChildren(...box.childNodes);
    // In the corner farther from the joint.
    callout.classList.toggle("right", x < one("#scene").viewBox.baseVal.width / 2);
  };

  const mark = () => {
    const j = chosen();
    parts.joints.forEach((g, n) => { g.classList.toggle("hot", n === j); g.setAttribute("aria-pressed", String(n === pinned)); });
    data.connections.forEach((c, n) => {
      parts.rows[n].classList.toggle("hot", c.joint === j);
      parts.curves[n]?.classList.toggle("hot", c.joint === j);
    });
    parts.strips[0]?.classList.toggle("chosen", data.connections.some((c) => c.joint === j));
    draw();
  };
  const point = (j) => { pointed = j; mark(); };
  const pin = (j) => { pinned = pinned === j ? null : j; mark(); };

  parts.joints.forEach((g, j) => {
    g.addEventListener("pointerenter", () => point(j));
    g.addEventListener("pointerleave", () => point(null));
    g.addEventListener("focus", () => { if (g.matches(":focus-visible")) point(j); });
    g.addEventListener("blur", () => point(null));
    g.addEventListener("click", () => pin(j));
    g.addEventListener("keydown", (event) => { if (event.key === "Enter") { event.preventDefault(); pin(j); } });
  });
  parts.rows.forEach((row, n) => {
    row.addEventListener("pointerenter", () => point(data.connections[n].joint));
    row.addEventListener("pointerleave", () => point(null));
    row.addEventListener("click", () => pin(data.connections[n].joint));
  });

  // --- time ------------------------------------------------------------------------------------

  const go = (to) => { now = Math.min(time[last], Math.max(time[0], to)); draw(); };

  const turn = (on) => {
    playing = on && last > 0;
    document.body.classList.toggle("playing", playing);
    play?.setAttribute("aria-label", playing ? "Pause" : "Play");
    cancelAnimationFrame(request);
    if (!playing) return;
    if (direction > 0 && now >= time[last]) now = time[0];
    if (direction < 0 && now <= time[0]) direction = 1;
    before = rest = 0;
    request = requestAnimationFrame(run);
  };

  const run = (moment) => {
    const passed = before ? Math.min(100, moment - before) : 0;
    before = moment;
    request = requestAnimationFrame(run);
    if (rest > 0) {
      rest -= passed;
      if (rest > 0) return;
      if (one("#end").value === "repeat") { now = time[0]; draw(); return; }
    }
    now += (direction * passed * Number(one("#speed").value)) / 1000;
    if (direction > 0 ? now < time[last] : now > time[0]) { draw(); return; }
    const end = one("#end").value;
    now = direction > 0 ? time[last] : time[0];
    if (end === "stop") turn(false);
    else rest = PAUSE;
    direction = end === "return" ? -direction : 1;
    draw();
  };

  const step = (by) => { turn(false); go(time[Math.min(last, Math.max(0, nearest() + by))]); };

  if (seek) {
    play.addEventListener("click", () => turn(!playing));
    one("#back").addEventListener("click", () => step(-1));
    one("#on").addEventListener("click", () => step(1));
    one("#end").addEventListener("change", () => { direction = 1; });
    seek.addEventListener("input", () => { turn(false); go(time[Number(seek.value)]); });
    document.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey || event.target.matches("select")) return;
      const by = event.shiftKey ? 10 : 1;
      if (event.key === " " && !event.target.matches("button, input[type=checkbox]")) turn(!playing);
      else if (event.key === "ArrowLeft") step(-by);
      else if (event.key === "ArrowRight") step(by);
      else if (event.key === "Home") step(-last);
      else if (event.key === "End") step(last);
      else return;
      event.preventDefault();
    });
  }
  document.addEventListener("keydown", (event) => { if (event.key === "Escape") { pinned = pointed = null; mark(); } });
  for (const strip of parts.strips) {
    const drag = (event) => {
      const spot = new DOMPoint(event.clientX, event.clientY).matrixTransform(strip.getScreenCTM().inverse());
      turn(false);
      go(time[0] + (span * (spot.x - LEFT)) / (RIGHT - LEFT));
      go(time[nearest()]);
    };
    strip.addEventListener("pointerdown", (event) => { strip.setPointerCapture(event.pointerId); drag(event); });
    strip.addEventListener("pointermove", (event) => { if (event.buttons & 1) drag(event); });
  }

  // --- choices ---------------------------------------------------------------------------------

  const rescale = () => {
    root = one("#scale").value === "sqrt";
    if (key) { const l = length(Number(key.dataset.size)); stretch(key, l); key.querySelector("text").setAttribute("x", (l + 8).toFixed(2)); }
    draw();
  };
  one("#scale").addEventListener("change", rescale);
  const show = (box) => document.body.classList.toggle(`with-${box.dataset.show}`, box.checked);
  for (const box of all("[data-show]")) { box.addEventListener("change", () => show(box)); show(box); }
  addEventListener("resize", draw);

  space?.start(draw);
  for (const part of all(".controls, .help")) part.hidden = false;
  rescale();
  // animation_x.html#t=1.5 opens at that time; otherwise it plays, unless the user prefers reduced
  // motion or the page is embedded in another.
  const start = /^#t=([-+.\deE]+)$/.exec(location.hash);
  if (start && Number.isFinite(Number(start[1]))) go(Number(start[1]));
  else if (last > 0 && self === top && !matchMedia("(prefers-reduced-motion: reduce)").matches) turn(true);
})();
