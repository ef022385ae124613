// What is drawn over a view: loads, axes, the maximum, the probe; and its scale.

// Labels on a canvas; each is moved down until it overlaps no other.
const labels = (flat, ratio, ink, halo) => {
  const taken = [];
  flat.font = `${12 * ratio}px system-ui, sans-serif`;
  flat.lineJoin = "round";
  return (text, x, y, colour = ink) => {
    const wide = flat.measureText(text).width, high = 14 * ratio;
    x = Math.max(2 * ratio, Math.min(x, flat.canvas.width - wide - 2 * ratio));
    y = Math.max(high, Math.min(y, flat.canvas.height - 4 * ratio));
    const over = () => taken.some(([a, b, w]) => x < a + w && a < x + wide && Math.abs(y - b) < high);
    for (let k = 0; k < 12 && over(); k++) y += y + high > flat.canvas.height ? -12 * high : high;
    taken.push([x, y, wide]);
    flat.lineWidth = 4 * ratio;
    flat.strokeStyle = halo;
    flat.strokeText(text, x, y);
    flat.fillStyle = colour;
    flat.fillText(text, x, y);
  };
};

// Its tip is a point, too, for one along the line of sight.
const arrow = (flat, [x0, y0], [x1, y1], colour, halo, ratio) => {
  const long = Math.hypot(x1 - x0, y1 - y0) || 1, head = Math.min(9 * ratio, long), [c, s] = [(x1 - x0) / long, (y1 - y0) / long];
  const shaft = new Path2D(), point = new Path2D();
  shaft.moveTo(x0, y0);
  shaft.lineTo(x1 - head * c, y1 - head * s);
  point.arc(x1, y1, 2 * ratio, 0, 7);
  point.moveTo(x1, y1);
  point.lineTo(x1 - head * (c - 0.5 * s), y1 - head * (s + 0.5 * c));
  point.lineTo(x1 - head * (c + 0.5 * s), y1 - head * (s - 0.5 * c));
  point.closePath();
  flat.lineJoin = "round";
  for (const [paint, wide] of [[halo, 5 * ratio], [colour, 2.5 * ratio]]) {
    flat.strokeStyle = flat.fillStyle = paint;
    flat.lineWidth = wide;
    flat.stroke(shaft);
    if (paint === halo) flat.stroke(point);
    flat.fill(point);
  }
};

// Forces on the bands at an instant; the tip is where the link pushes.
const forcesAt = (chosen, instant) => chosen.loads.map((load) => {
  const force = [...load.forces.subarray(3 * instant, 3 * instant + 3)], size = Math.hypot(...force);
  return { ...load, size, along: force.map((x) => x / (size || 1)) };
});

// Where the arrow of a force begins and ends.
const arrowOf = ({ z, radius, size, along }, longest, most) => {
  const tip = along.map((c, i) => (i === 2 ? z : 0) - radius * c);
  return [tip.map((c, i) => c - most * (0.05 + (0.2 * size) / longest) * along[i]), tip];
};

const largestForce = (chosen) => Math.max(0, ...chosen.loads.flatMap((load) => {
  const sizes = [];
  for (let i = 0; i < load.forces.length; i += 3) sizes.push(Math.hypot(...load.forces.subarray(i, i + 3)));
  return sizes;
}));
