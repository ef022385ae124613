"use strict";
// A linkage in space: it is seen from an azimuth about its vertical and an elevation.
const inSpace = (data) => {
  const all = (selector) => [...document.querySelectorAll(selector)];
  const scene = document.querySelector(".scene"), picture = document.querySelector("#scene");
  const { width, height } = picture.viewBox.baseVal;
  const { base, reach, labels, axes, curves } = data.space, [right0, up0, near0] = base;
  const shown = { axes: all("[data-axis]"), tracks: all("[data-track]"), paths: all("[data-path]"), grounds: all("[data-ground]"), names: all("[data-joint] text"), links: all("[data-link]") };
  const withAxis = axes.flatMap((axis, j) => (axis ? [j] : []));
  const bar = document.querySelector(".keys > path"), barWords = document.querySelector(".keys > text");
  const barLength = Number(/H([\d.]+)/.exec(bar.getAttribute("d"))[1]);
  const views = all("[data-view]"), told = document.querySelector("#view");
  const RADIAN = Math.PI / 180, STEP = 5, TRIAD = 30; // degrees of a key; the arrows of the axes
  const first = views[0].dataset.view.split(" ").map(Number);
  let [azimuth, elevation] = first, zoom = 1, turn, redraw, stale = true;

  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const mixed = (...terms) => [0, 1, 2].map((i) => terms.reduce((sum, [weight, v]) => sum + weight * v[i], 0));
  const place = (x, y) => `translate(${x.toFixed(2)} ${y.toFixed(2)})`;
  const line = (points) => "M" + points.map((p) => p[0].toFixed(2) + "," + p[1].toFixed(2)).join(" ");

  // Rows right, up and towards the viewer.
  const look = () => {
    const [c, s, ce, se] = [Math.cos(azimuth * RADIAN), Math.sin(azimuth * RADIAN), Math.cos(elevation * RADIAN), Math.sin(elevation * RADIAN)];
    turn = [mixed([c, right0], [-s, near0]), mixed([-se * s, right0], [-se * c, near0], [ce, up0]), mixed([ce * s, right0], [ce * c, near0], [se, up0])];
    stale = true;
  };
  const seen = (p) => [width / 2 + zoom * dot(turn[0], p), height / 2 - zoom * dot(turn[1], p), zoom * dot(turn[2], p)];
  const aimed = (v) => [dot(turn[0], v), -dot(turn[1], v)];
  const spotted = (values, i) => seen(values.slice(3 * i, 3 * i + 3));

  // The farthest body is drawn first.
  const stack = (joints) => {
    const depth = data.links.map((link) => link.reduce((sum, j) => sum + joints[j][2], 0) / (link.length || 1));
    const order = [...depth.keys()].sort((a, b) => depth[a] - depth[b]).map((b) => shown.links[b]);
    const parent = shown.links[0]?.parentNode;
    if (order.some((g, k) => parent.children[k] !== g)) parent.append(...order);
  };

  // Each name where it hides least, over the motion, of joints, lines and other names: as
  // reports/format/drawing/svg_labels.py, whose costs these are.
  const WAYS = [[1, -1], [-1, -1], [1, 1], [-1, 1], [1, 0], [-1, 0], [0, -1], [0, 1]], SAMPLES = 24;
  const offsetsOf = (half) => [1, 1.7].flatMap((far) => WAYS.map(([dx, dy]) => {
    const gap = labels.gap * far * (dx && dy ? 0.8 : 1);
    return [dx * (half[0] + gap), dy * (half[1] + gap), 0.5 * (far - 1)];
  }));
  const inked = (pairs) => pairs.flatMap(([a, b]) => Array.from({ length: SAMPLES }, (_, k) => [0, 1].map((i) => a[i] + ((b[i] - a[i]) * k) / (SAMPLES - 1))));
  const sampled = () => {
    const last = data.time.length - 1, count = Math.min(last + 1, 12, Math.ceil(200 / (data.at.length || 1)));
    return Array.from({ length: count }, (_, k) => {
      const i = count > 1 ? Math.round((last * k) / (count - 1)) : 0, joints = data.at.map((values) => spotted(values, i));
      const sides = data.links.flatMap((link) => link.map((j, n) => [joints[j], joints[link[(n + 1) % link.length]]]));
      return { joints, ink: inked([...sides, ...[...data.slides.map(({ ends }) => ends), ...data.springs].map((ends) => [spotted(ends, 2 * i), spotted(ends, 2 * i + 1)])]), boxes: [] };
    });
  };
  const name = () => {
    const frames = sampled(), large = shown.names.length ? parseFloat(getComputedStyle(shown.names[0]).fontSize) / 14 : 1; // on a phone
    shown.names.forEach((text, j) => {
      const half = labels.sizes[j].map((size) => (large * size) / 2);
      const inside = (points, more, x, y) => points.reduce((sum, p) => sum + (Math.abs(p[0] - x) < half[0] + more && Math.abs(p[1] - y) < half[1] + more), 0);
      let least = Infinity, best = null;
      for (const [ox, oy, far] of offsetsOf(half)) {
        const cost = far + frames.reduce((sum, { joints, ink, boxes }) => {
          const x = joints[j][0] + ox, y = joints[j][1] + oy;
          const outside = x < half[0] || y < half[1] || x > width - half[0] || y > height - half[1];
          const over = boxes.reduce((n, [bx, by, w, h]) => n + (Math.abs(bx - x) < half[0] + w && Math.abs(by - y) < half[1] + h), 0);
          return sum + (8 * inside(ink, 2, x, y)) / SAMPLES + 6 * inside(joints, 4, x, y) + 20 * outside + 10 * over;
        }, 0) / frames.length;
        if (cost < least - 1e-9) [least, best] = [cost, [ox, oy]];
      }
      for (const { joints, boxes } of frames) boxes.push([joints[j][0] + best[0], joints[j][1] + best[1], ...half]);
      text.setAttribute("x", best[0].toFixed(1));
      text.setAttribute("y", (best[1] + 4.5 * large).toFixed(1));
    });
  };

  const triad = document.createElementNS(picture.namespaceURI, "g");
  triad.setAttribute("class", "triad");
  triad.setAttribute("aria-hidden", "true");
  triad.innerHTML = ["x", "y", "z"].map((axis) => `<path/><text>${axis}</text>`).join("");
  triad.setAttribute("transform", place(width - 60, height - 60));
  picture.append(triad);

  const draw = (f, joints, at) => {
    shown.axes.forEach((g, n) => {
      const j = withAxis[n], [x, y] = joints[j], [u, v] = aimed([0, 1, 2].map((i) => at(axes[j], f, 3, i)));
      reach.forEach((r, k) => g.children[k].setAttribute("d", line([[x - r * u, y - r * v], [x + r * u, y + r * v]])));
    });
    shown.grounds.forEach((g) => g.setAttribute("transform", place(...joints[g.dataset.ground])));
    stack(joints);
    if (!stale) return;
    stale = false;
    name();
    const curve = (values) => line(Array.from({ length: values.length / 3 }, (_, i) => spotted(values, i)));
    for (const path of shown.tracks) path.setAttribute("d", curve(data.at[path.dataset.track]));
    for (const path of shown.paths) {
      const values = curves[path.dataset.path];
      path.setAttribute("d", curve(values));
      path.nextElementSibling.setAttribute("transform", place(...spotted(values, 0)));
    }
    [0, 1, 2].forEach((i) => {
      const [u, v] = [turn[0][i], -turn[1][i]], end = Math.hypot(u, v) < 0.2;
      triad.children[2 * i].setAttribute("d", end ? "" : line([[0, 0], [TRIAD * u, TRIAD * v]]));
      const letter = triad.children[2 * i + 1];
      letter.setAttribute("x", (1.35 * TRIAD * u).toFixed(1));
      letter.setAttribute("y", (1.35 * TRIAD * v + 4).toFixed(1));
      letter.setAttribute("visibility", end ? "hidden" : "visible");
    });
    bar.setAttribute("d", `M0,-5V0H${(zoom * barLength).toFixed(2)}V-5`);
    barWords.setAttribute("x", (zoom * barLength + 8).toFixed(2));
    const preset = views.find((button) => button.dataset.view.split(" ").every((angle, i) => Math.abs(angle - [azimuth, elevation][i]) < 0.01));
    for (const button of views) button.setAttribute("aria-pressed", String(button === preset));
    told.textContent = preset ? preset.textContent : `azimuth ${Math.round(azimuth)}°, elevation ${Math.round(elevation)}°`;
  };

  const face = (a, e) => {
    azimuth = ((((a + 180) % 360) + 360) % 360) - 180;
    elevation = Math.min(90, Math.max(-90, e));
    look();
    redraw();
  };
  const spin = (a, e) => face(azimuth + a, elevation + e);
  const nearer = (by) => { zoom = Math.min(20, Math.max(0.3, zoom * by)); look(); redraw(); };
  const reset = () => { zoom = 1; face(...first); };

  const start = (drawAll) => {
    redraw = drawAll;
    for (const button of views) button.addEventListener("click", () => face(...button.dataset.view.split(" ").map(Number)));
    for (const button of all("[data-turn]")) button.addEventListener("click", () => spin(...button.dataset.turn.split(" ").map(Number)));
    for (const button of all("[data-zoom]")) button.addEventListener("click", () => nearer(Number(button.dataset.zoom)));
    scene.addEventListener("keydown", (event) => {
      if (event.target !== scene || event.ctrlKey || event.altKey || event.metaKey) return;
      const far = event.shiftKey ? 3 * STEP : STEP;
      const act = {
        ArrowLeft: () => spin(far, 0), ArrowRight: () => spin(-far, 0), ArrowUp: () => spin(0, -far), ArrowDown: () => spin(0, far),
        "+": () => nearer(1.2), "-": () => nearer(1 / 1.2), 0: reset,
      }[event.key];
      if (!act) return;
      event.preventDefault();
      event.stopPropagation(); // the arrow keys step the time elsewhere
      act();
    });
    let held = null, turning = false;
    picture.addEventListener("pointerdown", (event) => { held = [event.clientX, event.clientY]; turning = false; });
    picture.addEventListener("pointermove", (event) => {
      if (!held || !(event.buttons & 1)) return;
      const [x, y] = [event.clientX - held[0], event.clientY - held[1]];
      if (!turning && Math.hypot(x, y) < 4) return; // a click on a joint
      if (!turning) picture.setPointerCapture(event.pointerId);
      turning = true;
      held = [event.clientX, event.clientY];
      spin(-x / 2, y / 2);
    });
    for (const end of ["pointerup", "pointercancel"]) picture.addEventListener(end, () => { held = null; });
    scene.addEventListener("wheel", (event) => {
      if (document.activeElement !== scene) return; // the page scrolls
      event.preventDefault();
      nearer(Math.exp(-event.deltaY / 500));
    }, { passive: false });
  };

  look();
  return { seen, aimed, draw, start, stems: new Set(data.space.stems) };
};
