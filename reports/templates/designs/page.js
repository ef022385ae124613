// Connects the plots, the choices and the table of the designs.

const by = (id) => document.getElementById(id);
const CHOICES = ["view", "colour", "x", "y", "better-a", "better-b", "a", "b"];

const rgb = (colour) => {
  const flat = Object.assign(document.createElement("canvas"), { width: 1, height: 1 }).getContext("2d");
  flat.fillStyle = colour;
  flat.fillRect(0, 0, 1, 1);
  return [...flat.getImageData(0, 0, 1, 1).data.slice(0, 3)];
};
const RAMP = Array.from({ length: 256 }, (_, k) => {
  const at = (k / 255) * (STOPS.length - 1), i = Math.min(Math.floor(at), STOPS.length - 2), t = at - i;
  const ends = [STOPS[i], STOPS[i + 1]].map((s) => [1, 3, 5].map((j) => parseInt(s.slice(j, j + 2), 16)));
  return ends[0].reduce((sum, v, j) => (sum << 8) | Math.round(v + t * (ends[1][j] - v)), 0);
});

const explore = (model) => {
  const mask = new Uint8Array(model.count), ranges = new Map(), verdicts = model.texts.verdict.names;
  const wanted = new Uint8Array(verdicts.length + 2).fill(1); // none, the verdicts, failed
  const shown = { pointed: -1, kept: -1, sort: { key: "safety_factor", down: false }, axes: [], onFront: false };
  let now, scales, look, counts, order = [], front = [], listed = [], pending = 0, waiting = 0;

  const column = (id) => Number(by(id).value);
  const signs = () => ["better-a", "better-b"].map((id) => (by(id).value === "lower" ? 1 : -1));
  const objectives = () => [column("a"), column("b")];
  const design = () => (shown.pointed >= 0 ? shown.pointed : shown.kept);

  // --- colours ---------------------------------------------------------------------------------

  const shades = () => {
    const style = getComputedStyle(document.documentElement), probe = by("probe");
    const of = (name) => { probe.style.color = `var(--${name})`; return getComputedStyle(probe).color; };
    const dark = rgb(of("paper"))[0] < 128, c = column("colour");
    const series = ["s5", "s1", "s2", "s3", "s4", "s0", "hot"].map((name) => rgb(of(name)).reduce((sum, v) => (sum << 8) | v, 0));
    const plain = series[0], none = rgb(of("quiet")).reduce((sum, v) => (sum << 8) | v, 0);
    let colours;
    if (c === -1) colours = new Uint32Array(model.count).fill(plain);
    else if (c === -2) colours = Uint32Array.from(now.verdict, (v, d) => (now.failed[d] ? series[6] : v < 0 ? none : series[v % 6]));
    else if (model.columns[c].names) colours = Uint32Array.from(now.values[c], (v) => (v >= 0 ? series[v % 6] : none));
    else colours = Uint32Array.from(now.values[c], (v) => (Number.isFinite(v) ? RAMP[Math.round(255 * scales[c].at(v))] : none));
    look = { of: colours, series, none, paper: rgb(of("paper")), faint: rgb(dark ? "#34383f" : "#e3e6ea"), ink: of("ink"), quiet: of("quiet"), rule: of("rule"), accent: of("accent"), hot: of("hot"), halo: of("paper"), brush: dark ? "#6cb2f522" : "#0b5cad18", colorScheme: style.colorScheme };
    legend(c);
  };

  const legend = (c) => {
    const css = (v) => `rgb(${v >> 16}, ${(v >> 8) & 255}, ${v & 255})`;
    const key = (colour, text) => {
      const part = element("span", text);
      part.prepend(element("i", undefined, { style: "" }));
      part.firstChild.style.background = css(colour);
      return part;
    };
    const names = c === -2 ? verdicts : model.columns[c]?.names;
    if (c === -1) return by("legend").replaceChildren();
    if (names) return by("legend").replaceChildren(...names.slice(0, 12).map((name, k) => key(look.series[k % 6], name)));
    const bar = element("b", undefined, { class: "ramp" }), { low, high } = scales[c], unit = model.columns[c].unit;
    bar.style.background = `linear-gradient(to right, ${STOPS.join(", ")})`;
    by("legend").replaceChildren(element("span", `${model.columns[c].title}: ${short(low, 4)}`), bar, element("span", `${short(high, 4)}${unit ? ` ${unit}` : ""}${scales[c].log ? ", logarithmic" : ""}`));
  };

  // --- redrawing -------------------------------------------------------------------------------

  const choose = () => {
    counts = selected(model, now, ranges, wanted, mask);
    front = frontOf(order, ...objectives().map((c) => now.values[c]), signs(), mask);
    if (!shown.onFront) return;
    mask.fill(0);
    for (const d of front) mask[d] = 1;
    counts = { count: front.length, failed: 0 };
  };
  const marks = () => {
    lines.mark(mask, now, design());
    lines.brushes(ranges);
    scatter.mark(ranges, design());
  };
  // After a change of the selection: everything that shows it, in one frame. whole: from nothing;
  // held: by a pointer that is still down, so the table waits.
  const redraw = (whole = false, held = false) => {
    choose();
    lines.update(mask, counts.count, whole);
    scatter.draw(mask, now, { designs: front, axes: objectives(), signs: signs() });
    marks();
    by("count").textContent = `${counts.count.toLocaleString("en-US")} of ${model.count.toLocaleString("en-US")} designs selected`;
    clearTimeout(waiting);
    if (!held) waiting = setTimeout(list, 120);
  };
  let held = false;
  const later = (is = false) => {
    held = is;
    if (!pending) pending = requestAnimationFrame(() => { pending = 0; redraw(false, held); });
  };
  // What waits until the pointer rests: the table, the ranges as numbers, what a screen reader says.
  const list = () => {
    const columns = tableColumns(model, now), by_key = columns.find((c) => c.key === shown.sort.key) ?? columns[0];
    listed = sorted(mask, by_key, shown.sort.down);
    fillTable(by("selection"), columns, listed, shown.sort, { sort });
    const failed = counts.failed ? `, ${counts.failed.toLocaleString("en-US")} of them without a result` : "";
    const rest = listed.length > MOST ? ` The table has the first ${MOST}; the CSV file has all.` : "";
    by("status").textContent = `${by("count").textContent}${failed}; ${front.length.toLocaleString("en-US")} on the front.${rest}`;
    by("save").disabled = !listed.length;
    for (const row of document.querySelectorAll("#ranges tbody tr")) rangeInputs(Number(row.dataset.column), row);
  };
  const sort = (key) => {
    shown.sort = { key, down: shown.sort.key === key && !shown.sort.down };
    list();
  };
  const tell = () => card(by("card"), model, now, design(), shown.pointed < 0 || shown.pointed === shown.kept);

  // Scales, colours and places anew: other columns, another view, another size.
  const lay = () => {
    scales = model.columns.map((c) => scaleOf(c, now.values[c.index], model.required));
    shades();
    order = ordered(...objectives().map((c) => now.values[c]), signs());
    lines.lay(shown.axes, now, scales, look);
    scatter.lay([column("x"), column("y")], now, scales, look);
    redraw(true);
    tell();
  };
  const view = () => {
    now = viewed(model, model.views[Number(by("view").value)]);
    if (model.byKey.mass) for (const id of ["x", "y", "a", "b", "colour"]) by(id).querySelector(`[value="${model.byKey.mass.index}"]`).textContent = titled(model.byKey.mass);
    failures();
    lay();
  };

  // --- pointing and brushing -------------------------------------------------------------------

  const point = (d) => {
    if (d === shown.pointed) return;
    shown.pointed = d;
    tell();
    marks();
  };
  const keep = (d = shown.pointed) => {
    shown.kept = d === shown.kept ? -1 : d;
    tell();
    marks();
  };
  const brush = (c, range, is = false) => {
    if (range) ranges.set(c, range);
    else ranges.delete(c);
    later(is);
  };
  const on = { brush, release: () => later(), range: (c) => ranges.get(c), leave: () => point(-1), keep: () => keep() };
  const lines = linesOf(by("lines"), model, { ...on, point: (x, y) => point(lines.nearest(mask, x, y)) });
  const scatter = scatterOf(by("scatter"), model, { ...on, point: (x, y) => point(scatter.nearest(mask, x, y)) });

  by("scatter").addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step || event.target.tagName !== "CANVAS") return;
    const places = scatter.inOrder(mask), at = places.indexOf(shown.kept);
    if (!places.length) return;
    shown.kept = -1;
    keep(places[at < 0 ? 0 : Math.min(places.length - 1, Math.max(0, at + step))]);
    event.preventDefault();
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") { shown.kept = shown.pointed = -1; tell(); marks(); }
  });

  // --- choices ---------------------------------------------------------------------------------

  const options = (id, entries, chosen) => by(id).replaceChildren(...entries.map(([value, text]) => {
    const option = element("option", text, { value });
    option.selected = value === chosen;
    return option;
  }));
  const failures = () => {
    const sums = new Array(wanted.length).fill(0);
    for (const v of now.verdict) sums[v + 1]++;
    const names = ["no verdict", ...verdicts, FAILED];
    const boxes = names.map((name, k) => {
      const label = element("label"), box = element("input", undefined, { type: "checkbox" });
      box.checked = Boolean(wanted[k]);
      box.addEventListener("change", () => { wanted[k] = box.checked ? 1 : 0; later(); });
      label.append(box, ` ${name} (${sums[k].toLocaleString("en-US")})`);
      if (model.meaning[name]) label.title = model.meaning[name];
      return label;
    }).filter((_, k) => sums[k]);
    by("verdicts").replaceChildren(element("legend", "Verdict"), ...boxes);
  };
  const rangeInputs = (c, row) => {
    const range = ranges.get(c), column = model.columns[c];
    [...row.querySelectorAll("[data-end]")].forEach((input, k) => {
      if (input === document.activeElement) return;
      if (column.names) input.value = range ? String(Math.min(column.names.length - 1, Math.max(0, k ? Math.floor(range[1]) : Math.ceil(range[0])))) : "";
      else input.value = range && Number.isFinite(range[k]) ? Number(range[k].toPrecision(6)) : "";
    });
  };
  const rangeRow = (column) => {
    const row = element("tr", undefined, { "data-column": column.index }), c = column.index;
    const cell = (...parts) => { const made = element("td"); made.append(...parts); row.append(made); };
    const check = (text, checked, change) => {
      const label = element("label"), box = element("input", undefined, { type: "checkbox" });
      box.checked = checked;
      box.addEventListener("change", () => change(box.checked));
      label.append(box, element("span", text, { class: "unseen" }));
      return label;
    };
    row.append(element("th", titled(column), { scope: "row" }));
    cell(check(`axis of ${column.title}`, shown.axes.includes(c), (is) => {
      const set = new Set(shown.axes);
      if (is) set.add(c);
      else set.delete(c);
      shown.axes = [...set].sort((a, b) => a - b);
      lay();
    }));
    for (const end of ["from", "to"]) {
      const label = `${column.title} ${end}`, input = element(column.names ? "select" : "input", undefined, { "data-end": end, "aria-label": label, ...(column.names ? {} : { type: "number", step: "any" }) });
      if (column.names) input.append(element("option", "", { value: "" }), ...column.names.map((name, k) => element("option", name, { value: k })));
      input.addEventListener("change", () => {
        const [low, high] = [...row.querySelectorAll("[data-end]")].map((i) => i.value);
        brush(c, low === "" && high === "" ? null : [low === "" ? -Infinity : Number(low), high === "" ? Infinity : Number(high)]);
      });
      cell(input);
    }
    const positive = !column.names && scales[c].positive;
    cell(...(positive ? [check(`logarithmic scale of ${column.title}`, column.log, (is) => { column.log = is; lay(); })] : []));
    return row;
  };

  const finite = (c) => now.values[c.index].some(Number.isFinite);
  const varies = (c) => { let first = NaN; return now.values[c.index].some((v) => Number.isFinite(v) && ((first = first === first ? first : v), v !== first)); };
  const begin = () => {
    now = viewed(model, model.views[0]);
    scales = model.columns.map((c) => scaleOf(c, now.values[c.index], model.required));
    const { columns, byKey } = model, known = (key) => (byKey[key] && finite(byKey[key]) ? byKey[key].index : undefined);
    const moving = columns.filter((c) => c.of === "design" && varies(c)).map((c) => c.index);
    const results = ["mass", "max_von_mises", "safety_factor"].map(known).filter((c) => c !== undefined && varies(columns[c]));
    shown.axes = [...moving, ...results];
    if (!shown.axes.length) shown.axes = columns.slice(0, 1).map((c) => c.index);
    const x = known("mass") ?? moving[0] ?? 0, y = known("safety_factor") ?? known("max_von_mises") ?? moving[1] ?? x;
    const titles = columns.map((c) => [c.index, titled(c)]);
    const better = (c) => (HIGHER.has(columns[c].key) ? "higher" : "lower");
    options("view", model.views.map((v, k) => [k, v.title]), 0);
    options("x", titles, x);
    options("y", titles, y);
    options("a", titles, x);
    options("b", titles, y);
    options("colour", [...titles, [-2, "verdict"], [-1, "one colour"]], known("safety_factor") ?? (verdicts.length ? -2 : -1));
    by("better-a").value = better(x);
    by("better-b").value = better(y);
    for (const [id, other] of [["a", "better-a"], ["b", "better-b"]]) by(id).addEventListener("change", () => { by(other).value = better(column(id)); });
    for (const id of CHOICES) by(id).addEventListener("change", id === "view" ? view : lay);
    by("ranges").tBodies[0].append(...columns.map(rangeRow));
    by("on-front").addEventListener("change", () => { shown.onFront = by("on-front").checked; later(); });
    by("clear").addEventListener("click", () => {
      ranges.clear();
      wanted.fill(1);
      shown.onFront = by("on-front").checked = false;
      failures();
      later();
    });
    by("save").addEventListener("click", save);
    by("selection").tBodies[0].addEventListener("click", (event) => {
      const row = event.target.closest("tr");
      if (row) { shown.kept = -1; keep(Number(row.dataset.design)); }
    });
    by("selection").tBodies[0].addEventListener("pointerover", (event) => point(Number(event.target.closest("tr")?.dataset.design ?? -1)));
    by("selection").addEventListener("pointerleave", () => point(-1));
    view();
    let width = innerWidth;
    addEventListener("resize", () => { if (innerWidth !== width) { width = innerWidth; lay(); } });
  };
  const save = () => {
    const link = element("a", undefined, { download: "designs_selected.csv", href: URL.createObjectURL(new Blob([csvOf(tableColumns(model, now), listed)], { type: "text/csv" })) });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };

  begin();
  return { model, mask, ranges, brush, redraw, lay, csv: () => csvOf(tableColumns(model, now), listed), front: () => front, now: () => now, selected: () => counts };
};

// --- the page ------------------------------------------------------------------------------------

const root = document.documentElement, wantsDark = matchMedia("(prefers-color-scheme: dark)");
const isDark = () => (root.style.colorScheme || (wantsDark.matches ? "dark" : "light")) === "dark";
let page = null;
const reshade = () => {
  by("shade").textContent = isDark() ? "Light" : "Dark";
  page?.lay();
};
by("shade").addEventListener("click", () => { root.style.colorScheme = isDark() ? "light" : "dark"; reshade(); });
wantsDark.addEventListener("change", reshade);
// On paper everything is light.
let before = "";
addEventListener("beforeprint", () => { before = root.style.colorScheme; root.style.colorScheme = "light"; page?.lay(); });
addEventListener("afterprint", () => { root.style.colorScheme = before; page?.lay(); });

if ("DecompressionStream" in window) {
  unpacked(JSON.parse(by("data").textContent)).then((data) => {
    document.body.classList.add("ready");
    page = explore(modelOf(data));
    reshade();
    performance.mark("ready");
  });
} else by("old").hidden = false;
