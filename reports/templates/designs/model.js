// The designs: values of all columns for one pin and case, scales, selection, Pareto front.
// pinstress/explore/sweep/page.py packs the arrays.

const FAILED = "failed"; // of designs without result or verdict, next to the verdicts
const HIGHER = new Set(["safety_factor"]); // the others are better when lower

// Of texts: their names and each row's place in them, NaN for none.
const textsOf = ({ names, places }) => ({ names, at: Float64Array.from(places, (k) => (k ? k - 1 : NaN)) });

const modelOf = (data) => {
  const count = data.numbers.length;
  const texts = Object.fromEntries(Object.entries(data.texts).map(([name, text]) => [name, textsOf(text)]));
  const columns = data.columns.map((c, index) => ({ ...c, index, all: c.names ? textsOf(c).at : c.values, log: false, limit: c.key === "safety_factor" ? data.required : null }));
  const pairs = new Map();
  for (let r = 0; r < texts.pin.at.length; r++) {
    const pin = texts.pin.at[r], load = texts.case.at[r];
    if (pin >= 0 && load >= 0) pairs.set(`${pin} ${load}`, { pin, load });
  }
  const views = [...pairs.values()].map((v) => ({ ...v, title: `pin ${texts.pin.names[v.pin]}, ${texts.case.names[v.load]}` }));
  if (views.length !== 1) views.unshift({ pin: -1, load: -1, title: "least factor over all pins and cases" });
  const byKey = Object.fromEntries(columns.map((c) => [c.key, c]));
  return { ...data, count, texts, columns, byKey, views };
};

// Of every design the row that a view shows, -1 for none, and whether it has no result.
const rowsOf = (model, { pin, load }) => {
  const { count, first, texts, byKey } = model, row = new Int32Array(count).fill(-1), failed = new Uint8Array(count);
  const factor = byKey.safety_factor?.all, stress = byKey.max_von_mises?.all;
  const fits = (is, wanted) => wanted < 0 || is === wanted || Number.isNaN(is);
  const worse = (a, b) => {
    const p = factor ? factor[a] : NaN, q = factor ? factor[b] : NaN;
    if (p === p || q === q) return q !== q || p < q;
    return stress && (stress[a] > stress[b] || stress[b] !== stress[b]);
  };
  for (let d = 0; d < count; d++) {
    for (let r = first[d]; r < first[d + 1] && !failed[d]; r++) {
      if (!fits(texts.pin.at[r], pin) || !fits(texts.case.at[r], load)) continue;
      if (texts.reason.at[r] >= 0 && !(stress && Number.isFinite(stress[r]))) failed[d] = 1;
      if (failed[d] || row[d] < 0 || worse(r, row[d])) row[d] = r;
    }
  }
  return { row, failed };
};

// Of every design the mass of all its pins; NaN where one is not known.
const massesOf = ({ count, first, texts, byKey }) => Float64Array.from({ length: count }, (_, d) => {
  const each = new Map();
  for (let r = first[d]; r < first[d + 1]; r++) {
    const pin = texts.pin.at[r], mass = byKey.mass.all[r];
    if (!Number.isFinite(each.get(pin))) each.set(pin, mass);
  }
  return [...each.values()].reduce((sum, mass) => sum + mass, 0);
});

// The values of every column in a view; results of failed designs are none.
const viewed = (model, view) => {
  const { row, failed } = rowsOf(model, view), { count, texts, byKey } = model;
  const pick = (all) => Float64Array.from({ length: count }, (_, d) => (row[d] < 0 || failed[d] ? NaN : all[row[d]]));
  const values = model.columns.map((c) => (c.of === "design" ? c.all : pick(c.all)));
  const several = view.pin < 0 && texts.pin.names.length > 1;
  if (byKey.mass) {
    if (several) values[byKey.mass.index] = massesOf(model).map((mass, d) => (failed[d] ? NaN : mass));
    byKey.mass.title = several ? "mass of all pins" : "mass";
  }
  const verdict = Int16Array.from({ length: count }, (_, d) => {
    const told = row[d] < 0 ? NaN : texts.verdict.at[row[d]];
    return told >= 0 ? told : failed[d] ? texts.verdict.names.length : -1;
  });
  return { row, failed, values, verdict };
};

// From values to 0 ... 1 and back, with ticks. A constant is in the middle.
const scaleOf = (column, values, required) => {
  if (column.names) {
    const n = column.names.length || 1;
    return { log: false, at: (v) => (v + 0.5) / n, back: (p) => p * n - 0.5, ticks: column.names.map((name, k) => [(k + 0.5) / n, name]) };
  }
  let low = Infinity, high = -Infinity;
  for (const v of values) if (Number.isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
  if (low <= high && column.key === "safety_factor" && required !== null) { low = Math.min(low, required); high = Math.max(high, required); }
  if (low > high) [low, high] = [0, 1];
  const positive = low > 0, log = column.log && positive, constant = low === high;
  if (constant) [low, high] = low ? [low - 0.5 * Math.abs(low), low + 0.5 * Math.abs(low)] : [-1, 1];
  const f = log ? Math.log : (v) => v, g = log ? Math.exp : (v) => v, a = f(low), b = f(high);
  const at = (v) => 0.02 + (0.96 * (f(v) - a)) / (b - a);
  const decades = log ? decadeTicks(low, high) : [];
  const ticks = constant ? [0.5 * (low + high)] : decades.length > 1 ? decades : roundTicks(low, high);
  const labels = tickLabels(ticks);
  return { log, positive, low, high, at, back: (p) => g(a + ((p - 0.02) / 0.96) * (b - a)), ticks: ticks.map((t, k) => [at(t), labels[k]]) };
};

// Which designs are in all ranges (columns to [low, high]) and have a wanted verdict.
const selected = (model, now, ranges, wanted, mask) => {
  const bounds = [...ranges].map(([c, [low, high]]) => [now.values[c], low, high]);
  let count = 0, failed = 0;
  for (let d = 0; d < model.count; d++) {
    let is = wanted[now.verdict[d] + 1];
    for (let k = 0; is && k < bounds.length; k++) {
      const v = bounds[k][0][d];
      if (!(v >= bounds[k][1] && v <= bounds[k][2])) is = 0;
    }
    mask[d] = is;
    count += is;
    failed += is & now.failed[d];
  }
  return { count, failed };
};

// Designs in the order of an objective, then of the other one, best first.
const ordered = (a, b, signs) => {
  const known = [];
  for (let d = 0; d < a.length; d++) if (Number.isFinite(a[d]) && Number.isFinite(b[d])) known.push(d);
  return Uint32Array.from(known.sort((i, j) => signs[0] * (a[i] - a[j]) || signs[1] * (b[i] - b[j])));
};

// The designs of a selection than which no other is better in one objective and as good in the other.
const frontOf = (order, a, b, signs, mask) => {
  const front = [];
  let best = Infinity, edge = NaN; // the least of b so far; the a at which it was reached
  for (const d of order) {
    if (!mask[d]) continue;
    const v = signs[1] * b[d];
    if (v < best || (v === best && a[d] === edge)) {
      best = v;
      edge = a[d];
      front.push(d);
    }
  }
  return front;
};
