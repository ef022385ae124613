// Numbers as text, ticks, and the colours of a scale.

const STOPS = ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"]; // viridis

// Number format of reports/format/numbers.py.
const written = (value, digits = 4) => {
  if (!Number.isFinite(value)) return "–";
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
const short = (value, digits = 6) => written(value, digits).replace(/(\.\d*?)0+(?=×|$)/, "$1").replace(/\.(?=×|$)/, "");

// Ticks as text, with the digits by which they differ.
const tickLabels = (ticks) => {
  for (let digits = 4; ; digits++) {
    const labels = ticks.map((t) => short(t, digits));
    if (digits >= 12 || new Set(labels).size === ticks.length) return labels;
  }
};

// Round numbers between two; on a scale of decades 1, 2 and 5 times powers of ten.
const roundTicks = (low, high, count = 5) => {
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 2.5, 5, 10].find((m) => m * power >= rough * (1 - 1e-9));
  const first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, k) => (first + k) * step);
};
const decadeTicks = (low, high) => {
  const found = [];
  for (let p = Math.floor(Math.log10(low)); p <= Math.log10(high); p++) {
    for (const m of [1, 2, 5]) found.push(m * 10 ** p);
  }
  return found.filter((x) => x >= low && x <= high);
};
