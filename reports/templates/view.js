// The interactive 3D view of a pin. The maxima shown next to it are those of the analysis.

// Number format of reports/format/numbers.py.
const written = (value, digits = 4) => {
  const rounded = Number(value.toPrecision(digits));
  if (!rounded) return "0";
  const size = Math.floor(Math.log10(Math.abs(rounded)) + 1e-9);
  const plain = (x, s) => {
    const d = Math.max(digits - 1 - s, 0);
    return x.toLocaleString("en-US", { minimumFractionDigits: d, maximumFractionDigits: d }).replace("-", "−");
  };
  if (size >= -3 && size < 7) return plain(rounded, size);
  const power = 3 * Math.floor(size / 3), raised = [...String(power)].map((c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]).join("");
  return `${plain(rounded / 10 ** power, size - power)}×10${raised}`;
};

const short = (value) => written(value, 6).replace(/(\.\d*?)0+(?=×|$)/, "$1").replace(/\.(?=×|$)/, "");

const product = (a, b) => a.map((row) => b[0].map((_, j) => row.reduce((sum, x, k) => sum + x * b[k][j], 0)));
const applied = (a, x) => a.map((row) => row.reduce((sum, y, k) => sum + y * x[k], 0));
const about = (axis, angle) => {
  const c = Math.cos(angle), s = Math.sin(angle), [i, j] = axis === "up" ? [2, 0] : [1, 2];
  const out = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  out[i][i] = out[j][j] = c;
  out[i][j] = -s;
  out[j][i] = s;
  return out;
};

const startView = (root, paint) => {
  const data = JSON.parse(root.querySelector("script").textContent);
  const surface = surfaceOf(data), shape = paint.upload(surface);
  const one = (name) => root.querySelector(`[data-is="${name}"]`);
  const canvas = root.querySelector("canvas"), flat = canvas.getContext("2d");
  let turn, zoom, chosen, exaggeration, drawn = 0, largestMoved;

  const reset = () => { turn = chosen.turn; zoom = 1; };
  const instant = () => (chosen.times ? Number(one("time").value) : chosen.instant);
  const factors = () => one("colour").value === "factor";
  const pressed = () => one("colour").value === "pressure";

  const compute = () => {
    if (pressed() && !(chosen.pressure && instant() === chosen.instant)) one("colour").value = "stress";
    const found = superposed(surface, chosen, instant());
    shape.set("value", pressed() ? pressing(surface, chosen.pressure) : found.value);
    shape.set("excluded", Float32Array.from({ length: surface.count * surface.around }, (_, v) => (pressed() ? 0 : chosen.excluded[Math.floor(v / surface.around)])));
    shape.set("moved", found.moved);
    return found;
  };

  const choose = () => {
    chosen = surface.cases[Number(one("case").value)];
    one("when").hidden = !chosen.times;
    if (chosen.times) {
      one("time").max = chosen.times.length - 1;
      one("time").value = chosen.instant;
    }
    const { moved } = compute();
    largestMoved = 0;
    for (let v = 0; v < moved.length; v += 3) largestMoved = Math.max(largestMoved, Math.hypot(moved[v], moved[v + 1], moved[v + 2]));
    reset();
    tell();
  };

  const tell = () => {
    const k = instant(), value = chosen.maxima[k], governs = k === chosen.instant, { units } = data;
    const when = chosen.times ? `t = ${short(chosen.times[k])} ${units.time}${governs ? ", the governing instant" : ""}: ` : "";
    const error = governs ? ` (${chosen.error})` : "";
    const where = chosen.zoned ? " outside the excluded zones" : "";
    const factor = data.strength ? `; safety factor ${governs ? chosen.factor : written(data.strength / value)} (${chosen.verdict})` : "";
    const largest = when ? "maximum" : "Maximum";
    one("told").textContent = `${when}${largest} von Mises stress${where} ${written(value)} ${units.stress}${error}${factor}.`;
    one("told").dataset.maximum = value;
    one("beneath").hidden = !(chosen.beneath && governs) || pressed();
    one("zones").hidden = !chosen.zoned || pressed();
    if (chosen.times) one("time").setAttribute("aria-valuetext", `${short(chosen.times[k])} ${units.time}`);
    scale();
    draw();
  };

  const top = () => (pressed() ? chosen.pressure.largest : chosen.maxima[chosen.instant]) || 1;
  const scale = () => {
    const ticks = [0, 0.25, 0.5, 0.75, 1].map((part) => {
      if (!factors()) return written(part * top(), 3);
      return (part === 0 ? "≥ " : "") + written((data.strength / top()) * 10 ** (DECADES * (1 - part)), 3);
    });
    const shown = pressed() ? "contact pressure" : "von Mises stress";
    one("unit").textContent = factors() ? `safety factor (${chosen.verdict})` : `${shown} [${data.units.stress}]`;
    one("ticks").replaceChildren(...ticks.map((t) => Object.assign(document.createElement("span"), { textContent: t })));
    exaggeration = largestMoved > 0 ? (0.15 * data.size * Number(one("deform").value)) / 100 / largestMoved : 0;
    one("deformed").textContent = exaggeration ? `× ${written(exaggeration, 3)}` : "not shown";
  };

  const draw = () => {
    cancelAnimationFrame(drawn);
    drawn = requestAnimationFrame(paintNow);
  };
  const paintNow = () => {
    const ratio = Math.min(devicePixelRatio, 2);
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (!width) return;
    canvas.width = width;
    canvas.height = height;
    // The whole bounding box fits the initial view.
    const half = data.box.map((c) => applied(chosen.turn, c.map((x, i) => x - data.centre[i])));
    const reach = (i) => Math.max(...half.map((c) => Math.abs(c[i])));
    const fit = (0.9 * zoom) / Math.max(reach(0), (reach(1) * width) / height);
    const scale = [fit, (fit * width) / height, -0.3 / data.size];
    flat.drawImage(paint.draw(shape, width, height, {
      turn, centre: data.centre, scale, exaggerated: exaggeration, top: top(), decades: factors() ? DECADES : 0,
    }), 0, 0);
    if (instant() === chosen.instant && !exaggeration && !pressed()) mark(width, height, scale, ratio);
  };

  // A dot at the maximum; a ring when it is on the far side.
  const mark = (width, height, scale, ratio) => {
    const [x, y, z] = applied(turn, chosen.location.map((c, i) => c - data.centre[i]));
    flat.beginPath();
    flat.arc((width * (1 + x * scale[0])) / 2, (height * (1 - y * scale[1])) / 2, 5 * ratio, 0, 7);
    flat.lineWidth = 2 * ratio;
    flat.fillStyle = flat.strokeStyle = "#d01c1c";
    flat.stroke();
    if (z > 0 && !chosen.beneath) flat.fill();
  };

  const spin = (across, up) => { turn = product(about("up", across), product(about("right", up), turn)); draw(); };
  const nearer = (by) => { zoom = Math.min(40, Math.max(0.3, zoom * by)); draw(); };

  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => { if (event.buttons & 1) spin(-event.movementX / 120, event.movementY / 120); });
  canvas.addEventListener("wheel", (event) => {
    if (document.activeElement !== canvas) return; // the page scrolls
    event.preventDefault();
    nearer(Math.exp(-event.deltaY / 500));
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const act = {
      ArrowLeft: () => spin(0.1, 0), ArrowRight: () => spin(-0.1, 0), ArrowUp: () => spin(0, -0.1), ArrowDown: () => spin(0, 0.1),
      "+": () => nearer(1.2), "-": () => nearer(1 / 1.2), 0: () => { reset(); draw(); },
    }[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act();
  });
  one("case").addEventListener("change", choose);
  one("colour").addEventListener("change", () => {
    if (pressed() && chosen.times) one("time").value = chosen.instant; // no other is known
    compute();
    tell();
  });
  one("deform").addEventListener("input", tell);
  one("time").addEventListener("input", () => { compute(); tell(); });
  one("governs").addEventListener("click", () => { one("time").value = chosen.instant; compute(); tell(); });
  one("nearer").addEventListener("click", () => nearer(1.3));
  one("further").addEventListener("click", () => nearer(1 / 1.3));
  one("reset").addEventListener("click", () => { reset(); draw(); });
  new ResizeObserver(draw).observe(canvas);
  choose();
};

const startViews = () => {
  const views = [...document.querySelectorAll("[data-view]")];
  const paint = views.length ? painter() : null;
  if (!paint) return; // the still pictures stay visible
  document.documentElement.classList.add("live");
  const watcher = new IntersectionObserver((seen) => {
    for (const { isIntersecting, target } of seen) {
      if (!isIntersecting) continue;
      watcher.unobserve(target);
      startView(target, paint);
    }
  }, { rootMargin: "300px" });
  views.forEach((view) => watcher.observe(view));
};
startViews();
