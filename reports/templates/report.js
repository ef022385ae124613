// Table sorting, folded parts, light and dark colours, animation frames.

const old = !("DecompressionStream" in window);
document.getElementById("old").hidden = !old;

const sortable = (table) => {
  const heads = [...table.tHead.rows[0].cells];
  const key = (row, k) => row.cells[k].dataset.value ?? row.cells[k].textContent.trim();
  const order = (a, b) => {
    if (a === "" || b === "") return (a === "") - (b === ""); // empty cells come last
    const x = Number(a), y = Number(b);
    return Number.isNaN(x) || Number.isNaN(y) ? a.localeCompare(b) : x - y;
  };
  heads.forEach((head, k) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    head.setAttribute("aria-sort", "none");
    button.addEventListener("click", () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      heads.forEach((h) => h.setAttribute("aria-sort", "none"));
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const known = (row) => key(row, k) !== "";
      const rows = [...table.tBodies[0].rows].sort((a, b) => (down && known(a) && known(b) ? -1 : 1) * order(key(a, k), key(b, k)));
      table.tBodies[0].append(...rows);
    });
  });
};

document.querySelectorAll("table.sortable").forEach(sortable);

// What makes a part of the page work, once it is there: functions of its element.
const starters = [];
const start = (starter) => {
  starters.push(starter);
  starter(document);
};
// A part of a long page is text until it is opened.
const fill = (part) => {
  const text = part.querySelector(":scope > noscript");
  if (!text) return;
  part.querySelector(":scope > .words")?.remove();
  text.outerHTML = text.textContent;
  starters.forEach((starter) => starter(part));
};

// The words of such a part, by which the browser's search finds and opens it.
const wordsOf = (text) => text.replace(/<(script|style|svg)[^]*?<\/\1>|<[^>]*>/g, " ").replace(/\s+/g, " ");
for (const text of document.querySelectorAll("details.fold > noscript")) {
  const words = document.createElement("div");
  words.className = "words";
  words.textContent = wordsOf(text.textContent);
  text.after(words);
}

// Folded parts open for links that lead into them, and all at once.
const folds = [...document.querySelectorAll("details.fold")];
const unfold = document.getElementById("unfold");
const folded = () => folds.some((part) => !part.open);
const named = () => { unfold.textContent = folded() ? "Open all parts" : "Close all parts"; };
const decoded = (text) => {
  try { return decodeURIComponent(text); } catch { return text; } // "50%"
};
const reveal = () => {
  const target = location.hash && document.getElementById(decoded(location.hash.slice(1)));
  if (!target) return;
  for (let part = target.closest("details"); part; part = part.parentElement.closest("details")) {
    part.open = true;
    fill(part);
  }
  target.scrollIntoView();
};
unfold.addEventListener("click", () => {
  const open = folded();
  for (const part of folds) {
    part.open = open;
    if (open) fill(part);
  }
  named();
});
folds.forEach((part) => part.addEventListener("toggle", () => {
  if (part.open) fill(part);
  named();
}));
// A pin takes the whole width while a part of it is open: what was clicked stays where it was.
for (const part of document.querySelectorAll(".pins details.fold")) {
  part.querySelector("summary").addEventListener("click", () => {
    const { top } = part.getBoundingClientRect();
    requestAnimationFrame(() => scrollBy(0, part.getBoundingClientRect().top - top));
  });
}
addEventListener("hashchange", reveal);
document.querySelector(".tools").hidden = false;
named();
reveal();

// A table that is wider than its place scrolls by keyboard, too.
let numbered = 0; // so that no two regions have one name
const sized = new ResizeObserver((seen) => {
  for (const { target } of seen) {
    if (target.scrollWidth <= target.clientWidth) {
      for (const name of ["tabindex", "role", "aria-label"]) target.removeAttribute(name);
      continue;
    }
    const heading = target.closest("details, section")?.querySelector("h2, h3, summary");
    target.tabIndex = 0;
    target.setAttribute("role", "region");
    target.setAttribute("aria-label", `Table ${++numbered}: ${heading?.textContent.trim() ?? ""}`);
  }
});
start((root) => root.querySelectorAll(".wide:not([tabindex])").forEach((box) => sized.observe(box)));

const shade = document.getElementById("shade");
const dark = () => (document.documentElement.style.colorScheme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
const shaded = () => {
  shade.textContent = dark() ? "Light" : "Dark";
  for (const frame of document.querySelectorAll("iframe")) {
    const inner = frame.contentDocument?.documentElement;
    if (inner) inner.style.colorScheme = document.documentElement.style.colorScheme;
  }
};
shade.addEventListener("click", () => { document.documentElement.style.colorScheme = dark() ? "light" : "dark"; shaded(); });
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", shaded);
shaded();

// Frame height follows its content.
const fit = (frame) => { frame.style.height = `${frame.contentDocument.documentElement.offsetHeight + 4}px`; };
const framed = (frame) => {
  shaded();
  new ResizeObserver(() => fit(frame)).observe(frame.contentDocument.documentElement);
};
start((root) => {
  for (const frame of old ? [] : root.querySelectorAll("iframe")) {
    frame.addEventListener("load", () => framed(frame));
    inflated(frame.dataset.packed).then((bytes) => { frame.srcdoc = new TextDecoder().decode(bytes); });
  }
});
