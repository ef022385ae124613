// The interactive 3D view of a pin. The maxima shown next to it are those of the analysis.

const product = (a, b) => a.map((row) => b[0].map((_, j) => row.reduce((sum, x, k) => sum + x * b[k][j], 0)));
const applied = (a, x) => a.map((row) => row.reduce((sum, y, k) => sum + y * x[k], 0));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((x) => x / Math.hypot(...a));
const about = (axis, angle) => {
  const c = Math.cos(angle), s = Math.sin(angle), [i, j] = axis === "up" ? [2, 0] : [1, 2];
  const out = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  out[i][i] = out[j][j] = c;
  out[i][j] = -s;
  out[j][i] = s;
  return out;
};

// Rows right, up and towards the viewer, with z across the picture.
const facing = (direction) => {
  const towards = unit(direction), up = unit(cross([0, 0, 1], towards));
  return [cross(up, towards), up, towards];
};
const NONE = [0, 0, 0], RED = "#d01c1c", NOWHERE = -1e30;

const startView = (root, paint, data) => {
  const { units, strength } = data;
  const surfaces = data.surfaces.map(surfaceOf), cases = data.cases.map(caseOf);
  const one = (name) => root.querySelector(`[data-is="${name}"]`);
  const canvas = root.querySelector("canvas"), flat = canvas.getContext("2d");
  const allowed = strength && data.required ? strength / data.required : null;
  let turn, first, zoom, middle, chosen, surface, mesh, shape, cut, exaggeration = 0, drawn = 0, largestMoved, longest, probe, drawnAt;

  const instant = () => (chosen.times ? Number(one("time").value) : chosen.instant);
  const governs = () => instant() === chosen.instant;
  const factors = () => one("colour").value === "factor";
  const pressed = () => one("colour").value === "pressure";
  const opened = () => one("cut").checked;

  // Facing the maximum, from the end from which nothing hides it; of a pin that is cut open, the section.
  const base = () => {
    const outwards = [Math.cos(chosen.start), Math.sin(chosen.start), 0], [x, y, z] = chosen.turn[2];
    if (opened()) return facing(chosen.section.away.map((c, i) => c + 0.3 * outwards[i] + (i === 2 ? 0.3 * Math.sign(z) : 0)));
    return [chosen.turn, facing([x, y, -z]), facing(outwards)].find(clear) ?? chosen.turn;
  };
  const clear = ([, , towards]) => !hitOf(mesh, chosen.location.map((c, i) => c + 1e-3 * data.size * towards[i]), towards);
  const reset = () => { turn = first = base(); zoom = 1; middle = data.centre; };

  const choose = () => {
    chosen = cases[Number(one("case").value)];
    surface = surfaces[chosen.surface];
    shape?.drop();
    cut?.drop();
    mesh = meshOf(surface, chosen);
    shape = paint.upload(mesh);
    cut = chosen.section && paint.upload(chosen.section);
    cut?.set("value", chosen.section.value);
    longest = largestForce(chosen);
    one("when").hidden = !chosen.times;
    if (chosen.times) {
      one("time").max = chosen.times.length - 1;
      one("time").value = chosen.instant;
    }
    one("cut").disabled = !cut;
    one("cut").checked = chosen.beneath && Boolean(cut);
    compute();
    largestMoved = 0;
    for (let v = 0; v < mesh.moved.length; v += 3) largestMoved = Math.max(largestMoved, Math.hypot(mesh.moved[v], mesh.moved[v + 1], mesh.moved[v + 2]));
    reset();
    toMaximum();
  };

  // The section and the pressure of cells are known at the governing instant alone.
  const compute = () => {
    if (pressed() && !(chosen.pressure && governs())) one("colour").value = "stress";
    if (pressed() || !governs()) one("cut").checked = false;
    const found = superposed(surface, chosen, instant());
    mesh.value = pressed() ? pressing(surface, chosen) : found.value;
    mesh.moved = found.moved;
    shape.set("value", mesh.value);
    shape.set("moved", mesh.moved);
    // What lugs press on is hidden up to the first vertices that are read, whose stress has no part of theirs.
    mesh.unread = unreadOf(surface, chosen, instant());
    const hidden = mesh.unread ? Float32Array.from(mesh.unread, (x) => 1000 * x) : chosen.excluded;
    if (hidden) shape.set("excluded", Float32Array.from(hidden, (x) => (pressed() ? 0 : x)));
  };
  const update = () => {
    compute();
    if (probe) place(probe.z, probe.angle, probe.radius);
    tell();
  };

  const tell = () => {
    const k = instant(), value = chosen.maxima[k];
    const when = chosen.times ? `t = ${short(chosen.times[k])} ${units.time}${governs() ? ", the governing instant" : ""}: ` : "";
    const error = governs() ? ` (${chosen.error})` : "";
    const where = `${chosen.unread ? " of the surface" : ""}${chosen.zoned ? " outside the excluded zones" : ""}`;
    const factor = strength ? `; safety factor ${(governs() && chosen.factor) || written(strength / value, 3)} (${chosen.verdict})` : "";
    const largest = when ? "maximum" : "Maximum";
    one("told").textContent = `${when}${largest} von Mises stress${where} ${written(value)} ${units.stress}${error}${factor}.${governs() && chosen.row ? ` ${chosen.row}` : ""}`;
    one("told").dataset.maximum = value;
    one("beneath").hidden = !(chosen.beneath && governs()) || opened() || pressed();
    one("zones").hidden = !chosen.zoned || pressed();
    one("lugs").hidden = !chosen.unread || pressed();
    const loads = forcesAt(chosen, k).map((f) => `${f.name} ${f.held ? "clamped" : `${short(f.size, 4)} ${units.force}`}`);
    one("loads").textContent = loads.length ? `Forces on the pin: ${loads.join(", ")}.` : "";
    if (chosen.times) one("time").setAttribute("aria-valuetext", `${short(chosen.times[k])} ${units.time}`);
    scale();
    draw();
  };

  const top = () => (pressed() ? chosen.pressure.top : chosen.maxima[chosen.instant]) || 1;
  // Where a stress is on the colour bar, of its length.
  const along = (stress) => (factors() ? 1 + Math.log10(stress / top()) / DECADES : stress / top());
  const scale = () => {
    const shown = pressed() ? "cell mean pressure" : "von Mises stress", least = strength / top();
    one("unit").textContent = factors() ? `safety factor (${chosen.verdict})` : `${shown} [${units.stress}]`;
    const ticks = factors() ? decadeTicks(least, least * 10 ** DECADES).map((f) => [along(strength / f), short(f, 3)]) : roundTicks(0, top()).map((s) => [along(s), short(s, 4)]);
    const clear = ticks.filter(([at]) => at < 0.8).map(([at, text]) => tick(at, text));
    one("ticks").replaceChildren(...clear, tick(1, `${pressed() ? "≥ " : ""}${written(factors() ? least : top(), 3)}`, "end"));
    const marks = pressed() || !strength ? [] : [[strength, "yield", "black"], ...(allowed ? [[allowed, `required factor ${short(data.required)}`, "white"]] : [])];
    const on = marks.filter(([stress]) => along(stress) >= 0 && along(stress) <= 1), off = marks.filter((mark) => !on.includes(mark));
    one("marks").style.height = `${1.4 * on.length}em`;
    one("marks").replaceChildren(...on.map(([stress, name, line]) => tick(along(stress), factors() ? name : `${name} (${line} line)`, along(stress) > 0.6 ? "end" : "")));
    [...one("marks").children].forEach((mark, k) => { mark.style.height = `${1.4 * (on.length - k)}em`; }); // one row each
    one("off").textContent = off.length ? `not on the scale: ${off.map(([stress, name]) => `${name} at ${written(stress, 3)}`).join(", ")}` : "";
    exaggeration = largestMoved > 0 ? (0.15 * data.size * Number(one("deform").value)) / 100 / largestMoved : 0;
    one("deformed").textContent = exaggeration ? `× ${written(exaggeration, 3)}` : "not shown";
  };
  const tick = (at, text, side = "") => {
    const found = Object.assign(document.createElement("span"), { textContent: text, className: side });
    found.style.left = `${100 * at}%`;
    return found;
  };

  const draw = () => {
    cancelAnimationFrame(drawn);
    drawn = requestAnimationFrame(paintNow);
  };
  const paintNow = (onPaper = false) => {
    const ratio = onPaper === true ? 2 : Math.min(devicePixelRatio, 2);
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (!width) return;
    canvas.width = width;
    canvas.height = height;
    // The pin and its loads at the governing instant fit the initial view.
    const tails = forcesAt(chosen, chosen.instant).filter((f) => f.size).map((f) => arrowOf(f, longest, data.size)[0]);
    const half = [...data.box, ...tails].map((c) => applied(first, c.map((x, i) => x - data.centre[i])));
    const reach = (i) => Math.max(...half.map((c) => Math.abs(c[i])));
    const fit = (0.88 * zoom) / Math.max(reach(0), (reach(1) * width) / height);
    const scale = [fit, (fit * width) / height, -0.3 / data.size];
    drawnAt = { width, height, scale, ratio };
    const marked = pressed() || factors() ? [NOWHERE, NOWHERE] : [strength ?? NOWHERE, allowed ?? NOWHERE];
    const shapes = opened() ? [[shape, chosen.section.away], [cut, NONE]] : [[shape, NONE]];
    flat.drawImage(paint.draw(shapes, width, height, {
      turn, middle, scale, exaggerated: exaggeration, top: top(), decades: factors() ? DECADES : 0,
      zones: pressed() ? [] : chosen.zones, levels: marked, stripe: 4 * ratio,
    }), 0, 0);
    const style = getComputedStyle(root);
    const [ink, halo] = onPaper === true ? ["#000", "#fff"] : [style.color, style.getPropertyValue("background-color")];
    const label = labels(flat, ratio, ink, halo);
    axes(label, ink, halo);
    if (governs() && !exaggeration && !pressed()) mark(label);
    if (probe) cursor(ink);
    forces(label, ink, halo);
  };
  const onCanvas = (x) => {
    const [right, up, towards] = applied(turn, x.map((c, i) => c - middle[i])), { width, height, scale } = drawnAt;
    return [(width * (1 + right * scale[0])) / 2, (height * (1 - up * scale[1])) / 2, towards];
  };

  const forces = (label, ink, halo) => {
    const { ratio } = drawnAt;
    for (const force of forcesAt(chosen, instant())) {
      const { name, z, size, held } = force;
      if (held) {
        const [x, y] = onCanvas([0, 0, z]);
        label(`${name} clamped`, x + 4 * ratio, y + 4 * ratio);
      } else if (size) {
        const [from, to] = arrowOf(force, longest, data.size).map(onCanvas);
        arrow(flat, from, to, ink, halo, ratio);
        label(`${name} ${short(size, 4)} ${units.force}`, from[0] + 6 * ratio, from[1] + (from[1] > to[1] ? 14 : -5) * ratio);
      }
    }
  };
  const axes = (label, ink, halo) => {
    const { ratio, height } = drawnAt, from = [40 * ratio, height - 40 * ratio];
    [0, 1, 2].map((i) => [i, turn[2][i]]).sort((a, b) => a[1] - b[1]).forEach(([i]) => {
      const to = [from[0] + 28 * ratio * turn[0][i], from[1] - 28 * ratio * turn[1][i]];
      arrow(flat, from, to, ink, halo, 0.6 * ratio);
      label("xyz"[i], to[0] + 4 * ratio * Math.sign(turn[0][i]) - 3 * ratio, to[1] + (turn[1][i] > 0 ? -4 : 12) * ratio);
    });
  };

  // The maximum: a dot; a ring when something is in front of it.
  const mark = (label) => {
    const [x, y, towards] = onCanvas(chosen.location), { ratio } = drawnAt, near = hit(x / ratio, y / ratio);
    const seen = !near || towards >= applied(turn, near.place.map((c, i) => c - middle[i]))[2] - 0.01 * data.size;
    flat.beginPath();
    flat.arc(x, y, 6 * ratio, 0, 7);
    flat.setLineDash(seen ? [] : [3 * ratio, 3 * ratio]);
    flat.lineWidth = 2 * ratio;
    flat.fillStyle = RED;
    if (seen) flat.fill();
    flat.strokeStyle = "#fff";
    flat.lineWidth = 4 * ratio;
    flat.stroke();
    flat.strokeStyle = RED;
    flat.lineWidth = 2 * ratio;
    flat.stroke();
    flat.setLineDash([]);
    const hidden = chosen.beneath && !opened() ? ", inside" : ", behind";
    label(`max ${written(chosen.maxima[chosen.instant])} ${units.stress}${seen ? "" : hidden}`, x + 10 * ratio, y - 8 * ratio);
    Object.assign(one("told").dataset, { seen, x: x / ratio, y: y / ratio });
  };

  // The nearest point that is drawn at a place of the canvas, in CSS pixels.
  const hit = (x, y) => {
    const { width, height, scale, ratio } = drawnAt;
    const at = [(2 * x * ratio) / width - 1, 1 - (2 * y * ratio) / height].map((c, i) => c / scale[i]);
    const from = middle.map((c, i) => c + at[0] * turn[0][i] + at[1] * turn[1][i] + 2 * data.size * turn[2][i]);
    return struck(from, turn[2].map((c) => -c));
  };
  const struck = (from, way) => {
    const places = exaggeration ? mesh.places.map((x, i) => x + exaggeration * mesh.moved[i]) : mesh.places;
    const outer = hitOf({ ...mesh, places }, from, way, opened() ? chosen.section.away : null);
    const inner = opened() ? hitOf(chosen.section, from, way) : null;
    return inner && (!outer || inner.depth <= outer.depth + 1e-6 * data.size) ? { ...inner, inside: true } : outer;
  };
  const excluded = ({ place: [x, y, z], corners, inside }) => !pressed() && (
    chosen.zones.some(([r, height, radius]) => Math.hypot(Math.hypot(x, y) - r, z - height) < radius * (1 - 1e-6))
    || Boolean(chosen.excluded && !inside && corners.some((v) => chosen.excluded[v])));
  const byLugs = ({ corners, inside }) => Boolean(!pressed() && mesh.unread && !inside && corners.some((v) => mesh.unread[v]));
  // From the maximum, of the pin's size.
  const apart = ({ place }) => Math.hypot(...place.map((x, i) => x - chosen.location[i])) / data.size;
  // The largest stress beside a lug is read up to the edge, from where vertices are hidden.
  const atMaximum = (found) => Boolean(mesh.unread && governs() && !pressed() && apart(found) < 1e-3);
  const read = (found) => {
    const [x, y, z] = found.place, degrees = (Math.atan2(y, x) * 180) / Math.PI, radius = Math.hypot(x, y);
    const most = atMaximum(found), value = most ? chosen.maxima[chosen.instant] : found.value, shown = pressed() ? "cell mean pressure" : "von Mises stress";
    const factor = strength && !pressed() ? `, safety factor ${written(strength / value, 3)}` : "";
    const what = !most && byLugs(found) ? "pressed by a lug: contact is judged by itself" : excluded(found) ? "excluded zone, stress not evaluated" : `${shown} ${written(value)} ${units.stress}${factor}`;
    return { value, z, angle: degrees, radius, place: found.place, text: `${what}; z = ${short(z, 4)} ${units.length}, angle ${short(Number(degrees.toFixed(1)), 4)}°, radius ${short(radius, 4)} ${units.length}` };
  };

  // The probe: at a place of the canvas, or at z and an angle on the outside, or at a radius of the section.
  const show = (found, fields = true) => {
    probe = found && read(found);
    one("probed").textContent = probe ? `${probe.text}.` : "No point of the pin is there.";
    if (probe) {
      one("probed").dataset.value = probe.value;
      if (fields) {
        one("z").value = Number(probe.z.toPrecision(5));
        one("angle").value = Number(probe.angle.toFixed(2));
        one("radius").value = Number((side(probe.angle) * probe.radius).toPrecision(5));
      }
    } else delete one("probed").dataset.value;
    one("radial").hidden = !opened();
    one("turned").hidden = opened();
    draw();
  };
  const side = (degrees) => (Math.cos((degrees * Math.PI) / 180 - chosen.start) < 0 ? -1 : 1);
  const inSection = (z, r) => {
    const { away } = chosen.section, at = [r * Math.cos(chosen.start), r * Math.sin(chosen.start), z];
    return hitOf(chosen.section, at.map((c, i) => c + data.size * away[i]), away.map((c) => -c));
  };
  // radius: of a point in the section, given only if that is open; else the outermost point is taken.
  const place = (z, degrees, radius = null, fields = true) => {
    if (opened() && radius !== null) {
      // A point of the surface may miss the section by round-off.
      const inner = [1, 0.999, 1.001].reduce((found, part) => found ?? inSection(z, side(degrees) * radius * part), null);
      show(inner && { ...inner, inside: true }, fields);
      return;
    }
    const way = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180), 0];
    const from = way.map((c, i) => (i === 2 ? z : 2 * data.size * c));
    show(hitOf(mesh, from, way.map((c) => -c), opened() ? chosen.section.away : null), fields);
  };
  const toMaximum = () => {
    const [x, y, z] = chosen.location;
    place(z, (Math.atan2(y, x) * 180) / Math.PI, Math.hypot(x, y));
    // A bore is not struck from outside.
    if (governs() && !pressed() && !opened() && !chosen.beneath && !(probe && apart(probe) < 1e-2)) show({ place: chosen.location, value: chosen.maxima[chosen.instant], inside: true });
    tell();
  };
  const cursor = (ink) => {
    const [x, y] = onCanvas(probe.place), { ratio } = drawnAt;
    flat.strokeStyle = ink;
    flat.lineWidth = 1.5 * ratio;
    flat.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      flat.moveTo(x + 9 * ratio * dx, y + 9 * ratio * dy);
      flat.lineTo(x + 15 * ratio * dx, y + 15 * ratio * dy);
    }
    flat.stroke();
  };

  const spin = (across, up) => { turn = product(about("up", across), product(about("right", up), turn)); draw(); };
  const pan = (right, up) => {
    const by = 1 / (drawnAt.scale[0] * zoom);
    middle = middle.map((c, i) => c - zoom * by * (right * turn[0][i] + up * turn[1][i]));
    draw();
  };
  const nearer = (by) => { zoom = Math.min(40, Math.max(0.3, zoom * by)); draw(); };

  let held = null, gone = 0;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held = [event.clientX, event.clientY];
    gone = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    if (held && event.buttons & 1) {
      const [x, y] = [event.clientX - held[0], event.clientY - held[1]];
      held = [event.clientX, event.clientY];
      gone += Math.hypot(x, y);
      if (event.shiftKey) pan((2 * x) / canvas.clientWidth, (-2 * y) / canvas.clientWidth);
      else spin(-x / 120, y / 120);
      one("tip").hidden = true;
      return;
    }
    const found = drawnAt && event.pointerType === "mouse" ? hit(event.offsetX, event.offsetY) : null;
    one("tip").hidden = !found;
    if (!found) return;
    one("tip").textContent = read(found).text;
    one("tip").style.left = `${Math.min(event.offsetX + 14, canvas.clientWidth - 180)}px`;
    one("tip").style.top = `${event.offsetY + 18}px`;
  });
  canvas.addEventListener("pointerleave", () => { one("tip").hidden = true; });
  canvas.addEventListener("pointerup", (event) => {
    if (held && gone < 4) show(hit(event.offsetX, event.offsetY));
    held = null;
  });
  canvas.addEventListener("wheel", (event) => {
    if (document.activeElement !== canvas) return; // the page scrolls
    event.preventDefault();
    nearer(Math.exp(-event.deltaY / 500));
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    const move = turns && (event.shiftKey ? () => pan(0.1 * turns[0], 0.1 * turns[1]) : () => spin(-0.1 * turns[0], -0.1 * turns[1]));
    const act = move ?? { "+": () => nearer(1.2), "-": () => nearer(1 / 1.2), 0: () => { reset(); draw(); } }[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act();
  });
  one("case").addEventListener("change", choose);
  one("colour").addEventListener("change", () => {
    if (pressed() && chosen.times) one("time").value = chosen.instant; // no other is known
    update();
  });
  one("deform").addEventListener("input", () => {
    if (opened() && Number(one("deform").value)) open(false); // a section is shown as it was drawn
    tell();
  });
  const open = (wide) => {
    one("cut").checked = wide;
    if (wide) {
      one("deform").value = 0;
      if (pressed()) one("colour").value = "stress";
      if (chosen.times) one("time").value = chosen.instant;
    }
    compute();
    reset();
    toMaximum();
  };
  one("cut").addEventListener("change", () => open(opened()));
  one("time").addEventListener("input", update);
  one("governs").addEventListener("click", () => { one("time").value = chosen.instant; update(); });
  one("maximum").addEventListener("click", () => {
    if (chosen.times) one("time").value = chosen.instant;
    compute();
    toMaximum();
  });
  for (const name of ["z", "angle", "radius"]) {
    one(name).addEventListener("input", () => {
      const radius = Number(one("radius").value), on = (chosen.start * 180) / Math.PI;
      if (opened()) place(Number(one("z").value), radius < 0 ? on + 180 : on, Math.abs(radius), false);
      else place(Number(one("z").value), Number(one("angle").value), null, false);
    });
  }
  const fine = (size) => Number((10 ** Math.floor(Math.log10(size / 50))).toPrecision(1));
  one("z").step = one("radius").step = fine(data.size);
  one("nearer").addEventListener("click", () => nearer(1.3));
  one("further").addEventListener("click", () => nearer(1 / 1.3));
  one("reset").addEventListener("click", () => { reset(); draw(); });
  for (const [name, across, up] of [["left", 1, 0], ["right", -1, 0], ["up", 0, -1], ["down", 0, 1]]) one(name).addEventListener("click", () => spin(0.26 * across, 0.26 * up));
  new ResizeObserver(draw).observe(canvas);
  new MutationObserver(draw).observe(document.documentElement, { attributeFilter: ["style", "class"] });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  addEventListener("beforeprint", () => paintNow(true));
  addEventListener("afterprint", draw);
  one("case").value = data.opens;
  choose();
  paintNow();
};

// Each is unpacked when its part is opened, so that it can be printed, and started when it is seen.
const paint = document.querySelector("section.viewed") && !old ? painter() : null;
document.documentElement.classList.toggle("live", Boolean(paint));
const waiting = new Map();
const startWaiting = (view) => {
  const data = waiting.get(view);
  if (waiting.delete(view)) startView(view, paint, data);
};
const watcher = new IntersectionObserver((seen) => {
  for (const { isIntersecting, target } of seen) if (isIntersecting) startWaiting(target);
}, { rootMargin: "300px" });
let last = Promise.resolve(); // one after another: a page of many pins stays quick
const unpack = (view) => {
  last = last.then(async () => {
    waiting.set(view, await unpacked(JSON.parse(view.querySelector("script").textContent)));
    watcher.observe(view);
  });
};
start((root) => {
  if (!paint) {
    root.querySelectorAll("[data-unseen]").forEach((text) => { text.hidden = false; });
    return;
  }
  for (const view of root.querySelectorAll("[data-view]")) {
    const part = view.closest("details");
    if (part.open) unpack(view);
    else part.addEventListener("toggle", () => unpack(view), { once: true });
  }
});
addEventListener("beforeprint", () => [...waiting.keys()].forEach(startWaiting));
