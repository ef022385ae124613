// Superposition of a surface's unit fields at an instant. reports/page/viewer.py packs the arrays.

const unpacked = (Type, text) => new Type(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);

// Integers times a scale per point (or one scale for all).
const scaled = (whole, scale) => {
  const each = whole.length / scale.length;
  return Float32Array.from(whole, (x, i) => x * scale[Math.floor(i / each)]);
};

const surfaceOf = (data) => {
  const points = unpacked(Float32Array, data.points), count = points.length / 3;
  const around = data.sectors, K = data.n.length;
  const angles = Float64Array.from({ length: around }, (_, j) => (2 * Math.PI * j) / around);
  const surface = {
    points, count, around, K, n: data.n, even: data.even,
    cos: angles.map(Math.cos), sin: angles.map(Math.sin),
    stress: scaled(unpacked(Int16Array, data.stress), unpacked(Float32Array, data.stress_scale)),
    moved: scaled(unpacked(Int16Array, data.moved), [data.moved_scale]),
    waves: [...new Set(data.n)],
    cases: data.cases.map((c) => ({
      ...c, amounts: unpacked(Float32Array, c.amounts), excluded: unpacked(Uint8Array, c.excluded),
      pressure: c.pressure && { ...c.pressure, rings: unpacked(Int16Array, c.pressure.rings), cells: unpacked(Float32Array, c.pressure.cells) },
    })),
  };
  surface.places = revolved(surface);
  surface.triangles = data.triangles ? unpacked(Uint32Array, data.triangles) : strips(count, around);
  surface.normals = data.triangles ? new Float32Array(3 * count) : normals(surface);
  return surface;
};

const revolved = ({ points, count, around, cos, sin }) => {
  const out = new Float32Array(3 * count * around);
  for (let p = 0, v = 0; p < count; p++) {
    const x = points[3 * p], y = points[3 * p + 1];
    for (let j = 0; j < around; j++, v += 3) {
      out[v] = x * cos[j] - y * sin[j];
      out[v + 1] = x * sin[j] + y * cos[j];
      out[v + 2] = points[3 * p + 2];
    }
  }
  return out;
};

const strips = (count, around) => {
  const out = new Uint32Array(6 * (count - 1) * around);
  for (let p = 0, t = 0; p < count - 1; p++) {
    for (let j = 0; j < around; j++, t += 6) {
      const a = p * around + j, b = p * around + ((j + 1) % around);
      out[t] = a;
      out[t + 1] = out[t + 3] = b;
      out[t + 4] = b + around;
      out[t + 2] = out[t + 5] = a + around;
    }
  }
  return out;
};

// Vertex normals, averaged over adjacent triangles; points at edges are duplicated, so edges stay sharp.
const normals = ({ places: x, triangles }) => {
  const out = new Float32Array(x.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    for (let i = 0; i < 3; i++) {
      const j = (i + 1) % 3, k = (i + 2) % 3;
      const n = (x[b + j] - x[a + j]) * (x[c + k] - x[a + k]) - (x[b + k] - x[a + k]) * (x[c + j] - x[a + j]);
      out[a + i] += n;
      out[b + i] += n;
      out[c + i] += n;
    }
  }
  return out;
};

// Contact pressure of all vertices at the governing instant of a case.
const pressing = ({ count, around }, { sectors, rings, cells }) => Float32Array.from({ length: count * around }, (_, v) => {
  const ring = rings[Math.floor(v / around)];
  return ring < 0 ? 0 : cells[ring * sectors + (Math.round(((v % around) * sectors) / around) % sectors)];
});

// Von Mises stress and displacement (x, y, z) of all vertices at an instant of a case.
const superposed = (surface, chosen, instant) => {
  const { count, around, K, n, waves, even, cos, sin } = surface;
  const amount = chosen.amounts.subarray(2 * K * instant, 2 * K * (instant + 1));
  const value = new Float32Array(count * around), moved = new Float32Array(3 * count * around);
  const back = new Float64Array(8), forth = new Float64Array(8), eight = new Float64Array(8 * around);
  for (let p = 0; p < count; p++) {
    eight.fill(0);
    for (const wave of waves) {
      back.fill(0);
      forth.fill(0);
      for (let k = 0; k < K; k++) {
        if (n[k] !== wave) continue;
        for (let i = 0; i < 8; i++) {
          const unit = i < 5 ? surface.stress[(5 * p + i) * K + k] : surface.moved[(3 * p + i - 5) * K + k];
          back[i] += unit * amount[2 * k];
          forth[i] += unit * amount[2 * k + 1];
        }
      }
      for (let j = 0; j < around; j++) {
        const c = cos[(wave * j) % around], s = sin[(wave * j) % around];
        for (let i = 0; i < 8; i++) eight[8 * j + i] += even[i] ? c * back[i] + s * forth[i] : s * back[i] - c * forth[i];
      }
    }
    for (let j = 0; j < around; j++) {
      const at = 8 * j, v = p * around + j;
      let squares = 0;
      for (let i = at; i < at + 5; i++) squares += eight[i] * eight[i];
      value[v] = Math.sqrt(squares);
      moved[3 * v] = cos[j] * eight[at + 5] - sin[j] * eight[at + 6];
      moved[3 * v + 1] = sin[j] * eight[at + 5] + cos[j] * eight[at + 6];
      moved[3 * v + 2] = eight[at + 7];
    }
  }
  return { value, moved };
};
