// Plots are drawn from their data when they come into view; the libraries start with the first.

let libraries = null, specs = null; // until they are inflated

const startLibraries = () => {
  if (window.vega) return;
  const script = document.createElement("script");
  script.text = libraries;
  document.head.append(script);
};

const specOf = (figure) => structuredClone(specs[figure.dataset.plot][1]);

const cells = (text) => text.split("\n").map((line) => line.split(","));

// CSV as rows, here: Vega's reader compiles functions, which the page does not allow.
const readData = (part) => {
  if (typeof part.data?.values === "string") {
    const [head, ...rows] = cells(part.data.values);
    part.data = { values: rows.map((row) => Object.fromEntries(head.map((name, k) => [name, row[k] === "" ? null : Number(row[k])]))) };
  }
  [...(part.vconcat ?? []), ...(part.layer ?? [])].forEach(readData);
};

const theme = JSON.parse(document.getElementById("theme").textContent);
const pointed = document.createElement("div");
pointed.id = "pointed";
pointed.hidden = true;
document.body.append(pointed);

// Values under the pointer: a text, or values by name.
const showPointed = (_, event, item, value) => {
  pointed.hidden = value === null || value === undefined || value === "";
  if (pointed.hidden) return;
  const lines = typeof value === "object" ? Object.entries(value).map(([name, v]) => `${name}: ${v}`) : [String(value)];
  pointed.textContent = lines.join("\n");
  const { clientX: x, clientY: y } = event;
  const { width, height } = pointed.getBoundingClientRect();
  pointed.style.left = `${Math.max(4, x + 14 + width > innerWidth ? x - width - 14 : x + 14)}px`;
  pointed.style.top = `${Math.max(4, y + 14 + height > innerHeight ? y - height - 14 : y + 14)}px`;
};

const drawPlot = (figure) => {
  if (figure.dataset.drawn) return;
  figure.dataset.drawn = "yes";
  startLibraries();
  const spec = specOf(figure), box = figure.querySelector(".drawn");
  delete spec.title; // the caption says it
  readData(spec);
  const config = { ...theme, view: { ...theme.view, continuousWidth: Math.max(200, box.clientWidth - 80) } };
  const compiled = vegaLite.compile(spec, { config }).spec;
  const runtime = vega.parse(compiled, null, { ast: true }); // interpreted, since the page allows no eval
  const view = new vega.View(runtime, { expr: vega.expressionInterpreter, renderer: "svg", logLevel: vega.Error });
  view.tooltip(showPointed).initialize(box).hover().run();
};

const valuesOf = (figure) => {
  const { data: { values }, usermeta: { columns } } = specOf(figure);
  const rows = typeof values === "string" ? cells(values).slice(1) : values.map(Object.values);
  return [columns, ...rows.map((row) => row.slice(0, columns.length))];
};

const quoted = (cell) => (/[",\n]/.test(cell) ? `"${String(cell).replaceAll('"', '""')}"` : cell);

const fillValues = (details) => {
  if (details.querySelector("table")) return;
  const [head, ...body] = valuesOf(details.closest("figure"));
  const link = document.createElement("a");
  link.href = `data:text/csv;charset=utf-8,${encodeURIComponent([head, ...body].map((row) => row.map(quoted).join(",")).join("\n"))}`;
  link.download = "values.csv";
  link.textContent = "CSV";
  const box = document.createElement("div"), table = box.appendChild(document.createElement("table"));
  box.className = "wide";
  box.tabIndex = 0;
  box.setAttribute("role", "region");
  const caption = details.closest("figure").querySelector("figcaption");
  box.setAttribute("aria-label", `Values: ${caption?.textContent.trim() ?? ""}`);
  const fill = (part, row, kind) => {
    const line = part.insertRow();
    for (const value of row) {
      const cell = line.appendChild(document.createElement(kind));
      cell.className = "n";
      cell.textContent = value ?? "";
    }
  };
  fill(table.createTHead(), head, "th");
  const into = table.createTBody();
  body.forEach((row) => fill(into, row, "td"));
  details.append(link, box);
};

const nearby = new IntersectionObserver((seen) => {
  for (const { isIntersecting, target } of seen) {
    if (!isIntersecting) continue;
    nearby.unobserve(target);
    drawPlot(target);
  }
}, { rootMargin: "400px" });
const showPlots = (root) => {
  for (const figure of root.querySelectorAll("figure.plot")) {
    const details = figure.querySelector(".values");
    details.hidden = false;
    details.addEventListener("toggle", () => fillValues(details));
    nearby.observe(figure);
  }
};
const text = async (name) => new TextDecoder().decode(await inflated(document.getElementById(name).textContent));
if (!old) {
  Promise.all([text("libraries"), text("plots")]).then(([scripts, drawings]) => {
    libraries = scripts;
    specs = JSON.parse(drawings);
    start(showPlots);
  });
}
// On paper all that is open is drawn.
addEventListener("beforeprint", () => {
  if (libraries) [...document.querySelectorAll("figure.plot")].filter((figure) => figure.offsetParent).forEach(drawPlot);
});
