// Landmarks have names, and code or a table that is wider than its place scrolls by keyboard.

addEventListener("DOMContentLoaded", () => {
  const names = { "aside.sidebar-drawer": "All pages", "aside.toc-drawer": "On this page" };
  for (const [part, name] of Object.entries(names)) document.querySelector(part)?.setAttribute("aria-label", name);
  const sized = new ResizeObserver((seen) => {
    for (const { target } of seen) {
      if (target.scrollWidth > target.clientWidth) target.tabIndex = 0;
      else target.removeAttribute("tabindex");
    }
  });
  document.querySelectorAll("pre, .table-wrapper").forEach((box) => sized.observe(box));
});
