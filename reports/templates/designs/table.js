// What a reader reads: the design shown, the selected designs, their file.

const MOST = 300; // rows of the table

const element = (name, text, attributes = {}) => {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
};

const titled = ({ title, unit }) => (unit ? `${title} [${unit}]` : title);

// A key may be broken after its dots.
const breakable = (text) => text.replace(/([.\]_])(?=\w)/g, "$1\u200b");

// Digits of a column: results have no more than their errors leave them.
const digitsOf = ({ key, of }) => (/(^|_)error/.test(key) ? 2 : of === "row" ? 4 : 6);
// A value of a column for reading; the file has all digits. A factor has more where it would be
// rounded past the required one (reports/format/numbers.py: beside_limit).
const worded = (column, value, digits = digitsOf(column)) => {
  if (column.names) return value >= 0 ? column.names[value] : "–";
  if (!Number.isFinite(value)) return value === Infinity ? "∞" : "–";
  const hides = (n) => (Number(value.toPrecision(n)) >= column.limit) !== (value >= column.limit);
  while (column.limit !== null && digits < 9 && hides(digits)) digits++;
  return short(value, digits);
};
const exact = (column, value) => (column.names ? worded(column, value) : Number.isNaN(value) ? "" : String(value));

const nameOf = (text, r) => (r >= 0 && text.at[r] >= 0 ? text.names[text.at[r]] : "");

// All that is known of a design, with its rows of all pins and cases.
const card = (host, model, now, d, kept) => {
  if (d < 0) {
    host.replaceChildren(element("p", "Point at a line or a dot: here are the numbers of its design. A click keeps it.", { class: "quiet" }));
    return;
  }
  const { texts, columns, byKey } = model, list = element("dl"), row = now.row[d];
  const item = (term, text, value = "") => {
    const pair = element("div");
    pair.append(element("dt", term), element("dd", text, value === "" ? {} : { "data-value": value }));
    list.append(pair);
  };
  const told = [element("h3", `Design ${model.numbers[d]}${kept ? " (kept)" : ""}`)];
  if (now.failed[d]) told.push(element("p", `No result: ${nameOf(texts.reason, row)}`, { class: "fails" }));
  for (const c of columns) {
    const value = now.values[c.index][d];
    if (c.of === "row" && (now.failed[d] || c.key === "error_estimate")) continue;
    const error = c.key === "max_von_mises" && byKey.error_estimate ? ` ± ${worded(byKey.error_estimate, now.values[byKey.error_estimate.index][d])}` : "";
    item(c.title, `${worded(c, value)}${error}${c.unit && Number.isFinite(value) ? ` ${c.unit}` : ""}`, exact(c, value));
  }
  told.push(list);
  const verdict = now.failed[d] ? "" : nameOf(texts.verdict, row);
  if (!now.failed[d] && row >= 0) {
    const factor = byKey.safety_factor ? now.values[byKey.safety_factor.index][d] : NaN;
    const needed = model.required === null || !Number.isFinite(factor) ? "" : ` The safety factor is ${factor < model.required ? "below" : "not below"} the required ${short(model.required, 4)}.`;
    const meant = model.meaning[verdict] ? `${verdict}: ${model.meaning[verdict]}` : verdict;
    told.push(element("p", `Pin ${nameOf(texts.pin, row)}, case ${nameOf(texts.case, row)}. ${meant}${needed}`, { class: "quiet" }));
    if (nameOf(texts.reason, row)) told.push(element("p", `Note: ${nameOf(texts.reason, row)}`, { class: "quiet" }));
  }
  if (model.first[d + 1] - model.first[d] > 1) told.push(everyRow(model, d, row));
  host.replaceChildren(...told);
};

const everyRow = ({ texts, byKey, first }, d, governing) => {
  const table = element("table"), shown = ["max_von_mises", "safety_factor"].map((k) => byKey[k]).filter(Boolean);
  const head = table.createTHead().insertRow(), body = table.createTBody();
  for (const name of ["pin", "case", ...shown.map((c) => c.title), "verdict"]) head.append(element("th", name, { scope: "col" }));
  for (let r = first[d]; r < first[d + 1]; r++) {
    const row = body.insertRow();
    if (r === governing) row.className = "governs";
    const cells = [nameOf(texts.pin, r), nameOf(texts.case, r), ...shown.map((c) => worded(c, c.all[r])), nameOf(texts.verdict, r) || nameOf(texts.reason, r)];
    row.append(...cells.map((text) => element("td", text)));
  }
  const wide = element("div", undefined, { class: "wide", tabindex: "0", role: "region", "aria-label": "All pins and cases of the design" });
  wide.append(table);
  return wide;
};

// Columns of the table and of the file, each with its text of a design.
const tableColumns = (model, now) => [
  { key: "design", title: "design", numeric: true, of: (d) => model.numbers[d], text: (d) => String(model.numbers[d]), exact: (d) => String(model.numbers[d]) },
  ...["pin", "case"].map((key) => textColumn(model, now, key)),
  ...model.columns.map((c) => ({
    key: c.key, title: titled(c), numeric: !c.names,
    of: (d) => now.values[c.index][d],
    empty: !c.names && !c.all.some((value) => value === value),
    text: (d) => worded(c, now.values[c.index][d]),
    exact: (d) => exact(c, now.values[c.index][d]),
  })),
  ...["verdict", "reason", "code"].map((key) => textColumn(model, now, key)),
].filter((c) => !c.empty);

const textColumn = ({ texts }, now, key) => {
  const of = (d) => nameOf(texts[key], now.row[d]);
  return { key, title: key, numeric: false, empty: !texts[key].names.length, of, text: of, exact: of };
};

// The selected designs, by a column; those without a value come last.
const sorted = (mask, column, down) => {
  const found = [], sign = down ? -1 : 1, value = new Array(mask.length);
  for (let d = 0; d < mask.length; d++) if (mask[d]) { found.push(d); value[d] = column.of(d); }
  const none = (v) => v === "" || v !== v;
  return found.sort((a, b) => {
    const v = value[a], w = value[b];
    if (none(v) || none(w)) return none(v) - none(w) || a - b;
    return sign * (v < w ? -1 : v > w ? 1 : 0) || a - b;
  });
};

const fillTable = (host, columns, order, by, on) => {
  const head = element("tr"), body = host.tBodies[0];
  for (const c of columns) {
    const cell = element("th", undefined, { scope: "col", class: c.numeric ? "n" : "t", "aria-sort": c.key !== by.key ? "none" : by.down ? "descending" : "ascending" });
    const button = element("button", breakable(c.title), { type: "button", "data-key": c.key });
    button.addEventListener("click", () => on.sort(c.key));
    cell.append(button);
    head.append(cell);
  }
  const focused = document.activeElement?.dataset?.key;
  host.tHead.replaceChildren(head);
  if (focused) [...head.querySelectorAll("button")].find((b) => b.dataset.key === focused)?.focus();
  body.replaceChildren(...order.slice(0, MOST).map((d) => {
    const row = element("tr", undefined, { "data-design": d });
    columns.forEach((c, k) => {
      const cell = element("td", k ? c.text(d) : undefined, { class: c.numeric ? "n" : "t" });
      if (!k) cell.append(element("button", c.text(d), { type: "button", "aria-label": `Show design ${c.text(d)}` }));
      row.append(cell);
    });
    return row;
  }));
};

// Text which a spreadsheet shows and does not run, as reports/format/files/csv.py writes it.
const harmless = (text) => (/^\s*[=+\-@]|^[\t\r\n]/.test(text) ? `'${text}` : text);
const quoted = (text) => (/[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

const csvOf = (columns, order) => {
  const line = (cells) => cells.map(quoted).join(",");
  const rows = order.map((d) => line(columns.map((c) => (c.numeric ? c.exact(d) : harmless(c.exact(d))))));
  return `${[line(columns.map((c) => harmless(c.key))), ...rows].join("\n")}\n`;
};
