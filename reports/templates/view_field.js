// Superposition of surfaces' unit fields at an instant. reports/page/viewer.py packs the arrays.

// Integers times a scale per first index, or per last one.
const byFirst = (whole, scale) => {
  const each = whole.length / scale.length;
  return Float32Array.from(whole, (x, i) => x * scale[Math.floor(i / each)]);
};
const byLast = (whole, scale) => Float32Array.from(whole, (x, i) => x * scale[i % scale.length]);

// stress, moved: by unit load, component, point.
const surfaceOf = (data) => ({
  points: data.points, count: data.points.length / 3, around: data.sectors, K: data.n.length, n: data.n, even: data.even,
  waves: [...new Set(data.n)],
  stress: byLast(data.stress, data.stress_scale),
  moved: byFirst(data.moved, data.moved_scale),
  triangles: data.triangles,
});

// start: the angle of the maximum, at which the first meridian is drawn. amounts: by phase, unit load, instant.
const caseOf = (data) => ({
  ...data,
  start: Math.atan2(data.location[1], data.location[0]),
  amounts: byFirst(data.amounts, [...data.amounts_scale, ...data.amounts_scale]),
  loads: data.loads.map((load) => ({ ...load, forces: Float32Array.from(load.forces, (x) => x * load.scale) })),
  section: data.section && sectionOf(data.section),
});

const angles = (surface, start) => Float64Array.from({ length: surface.around }, (_, j) => start + (2 * Math.PI * j) / surface.around);

// What is drawn of a surface in a case: vertices, triangles, normals (none: flat facets).
const meshOf = (surface, chosen) => {
  if (surface.triangles) return { places: surface.points, triangles: surface.triangles, normals: new Float32Array(surface.points.length) };
  const mesh = { places: revolved(surface, angles(surface, chosen.start)), triangles: strips(surface.count, surface.around) };
  return { ...mesh, normals: normals(mesh) };
};

const revolved = ({ points, count }, turns) => {
  const out = new Float32Array(3 * count * turns.length);
  for (let p = 0, v = 0; p < count; p++) {
    for (const turn of turns) {
      out[v++] = points[3 * p] * Math.cos(turn);
      out[v++] = points[3 * p] * Math.sin(turn);
      out[v++] = points[3 * p + 2];
    }
  }
  return out;
};

const strips = (count, around, closed = true) => {
  const across = closed ? around : around - 1, out = new Uint32Array(6 * (count - 1) * across);
  for (let p = 0, t = 0; p < count - 1; p++) {
    for (let j = 0; j < across; j++, t += 6) {
      const a = p * around + j, b = p * around + ((j + 1) % around);
      out[t] = a;
      out[t + 1] = out[t + 3] = b;
      out[t + 4] = b + around;
      out[t + 2] = out[t + 5] = a + around;
    }
  }
  return out;
};

// Vertex normals, averaged over adjacent triangles; points at corners are duplicated, so these stay sharp.
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

// The plane through the axis and the maximum: vertices with their stress, both halves.
const sectionOf = (data) => {
  const { z, inner, outer, part } = data, x = Math.cos(data.angle), y = Math.sin(data.angle), places = [];
  for (const side of [1, -1]) {
    z.forEach((height, i) => part.forEach((along) => {
      const r = side * (inner[i] + along * (outer[i] - inner[i]));
      places.push(r * x, r * y, height);
    }));
  }
  const half = strips(z.length, part.length, false), all = new Uint32Array(2 * half.length);
  all.set(half);
  all.set(half.map((v) => v + z.length * part.length), half.length);
  return {
    places: new Float32Array(places), triangles: all, normals: new Float32Array(places.length),
    value: Float32Array.from(data.values, (v) => v * data.scale),
    away: [y, -x, 0], // from the half that is kept
  };
};

// Pressure of all vertices, the mean of their cell, at the governing instant of a case.
const pressing = (surface, { start, pressure: { sectors, first, rings, cells } }) => {
  const turns = angles(surface, start);
  return Float32Array.from({ length: surface.count * surface.around }, (_, v) => {
    const ring = rings[Math.floor(v / surface.around)], sector = Math.round(((turns[v % surface.around] - first) * sectors) / (2 * Math.PI));
    return ring < 0 ? 0 : cells[ring * sectors + (((sector % sectors) + sectors) % sectors)];
  });
};

// Which vertices are not read at an instant, for lugs press on them or beside: 1 or 0, null without lugs.
const unreadOf = (surface, { unread }, instant) => {
  if (!unread) return null;
  const count = surface.count * surface.around, first = instant * count;
  return Uint8Array.from({ length: count }, (_, v) => (unread[(first + v) >> 3] >> (7 - ((first + v) & 7))) & 1);
};

// Von Mises stress and displacement (x, y, z) of all vertices at an instant of a case.
const superposed = (surface, chosen, instant) => {
  const { count, around, K, n, waves, even } = surface, turns = angles(surface, surface.triangles ? 0 : chosen.start);
  const instants = chosen.amounts.length / (2 * K), amount = (phase, k) => chosen.amounts[(phase * K + k) * instants + instant];
  const first = surface.n.map((_, k) => amount(0, k)), second = surface.n.map((_, k) => amount(1, k));
  const cos = waves.map((wave) => turns.map((turn) => Math.cos(wave * turn))), sin = waves.map((wave) => turns.map((turn) => Math.sin(wave * turn)));
  const value = new Float32Array(count * around), moved = new Float32Array(3 * count * around);
  const back = new Float64Array(8), forth = new Float64Array(8), eight = new Float64Array(8 * around);
  for (let p = 0; p < count; p++) {
    eight.fill(0);
    waves.forEach((wave, w) => {
      back.fill(0);
      forth.fill(0);
      for (let k = 0; k < K; k++) {
        if (n[k] !== wave) continue;
        for (let i = 0; i < 8; i++) {
          const unit = i < 5 ? surface.stress[(5 * k + i) * count + p] : surface.moved[(3 * k + i - 5) * count + p];
          back[i] += unit * first[k];
          forth[i] += unit * second[k];
        }
      }
      for (let j = 0; j < around; j++) {
        const c = cos[w][j], s = sin[w][j];
        for (let i = 0; i < 8; i++) eight[8 * j + i] += even[i] ? c * back[i] + s * forth[i] : s * back[i] - c * forth[i];
      }
    });
    for (let j = 0; j < around; j++) {
      const at = 8 * j, v = p * around + j, c = Math.cos(turns[j]), s = Math.sin(turns[j]);
      let squares = 0;
      for (let i = at; i < at + 5; i++) squares += eight[i] * eight[i];
      value[v] = Math.sqrt(squares);
      moved[3 * v] = c * eight[at + 5] - s * eight[at + 6];
      moved[3 * v + 1] = s * eight[at + 5] + c * eight[at + 6];
      moved[3 * v + 2] = eight[at + 7];
    }
  }
  return { value, moved };
};

// The nearest triangle that a ray hits: how far along it, where, and the value there; null if it hits
// none. away: what is beyond the plane through the axis with this normal is cut off.
const hitOf = ({ places: x, triangles, value }, from, along, away = null) => {
  let found = null;
  const [dx, dy, dz] = along;
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ex = x[b] - x[a], ey = x[b + 1] - x[a + 1], ez = x[b + 2] - x[a + 2];
    const fx = x[c] - x[a], fy = x[c + 1] - x[a + 1], fz = x[c + 2] - x[a + 2];
    const px = dy * fz - dz * fy, py = dz * fx - dx * fz, pz = dx * fy - dy * fx;
    const det = ex * px + ey * py + ez * pz;
    if (!det) continue;
    const sx = from[0] - x[a], sy = from[1] - x[a + 1], sz = from[2] - x[a + 2];
    const u = (sx * px + sy * py + sz * pz) / det;
    if (u < -1e-6 || u > 1 + 1e-6) continue;
    const qx = sy * ez - sz * ey, qy = sz * ex - sx * ez, qz = sx * ey - sy * ex;
    const v = (dx * qx + dy * qy + dz * qz) / det;
    if (v < -1e-6 || u + v > 1 + 1e-6) continue;
    const depth = (fx * qx + fy * qy + fz * qz) / det;
    if (depth < 0 || (found && depth >= found.depth)) continue;
    const place = from.map((s, i) => s + depth * along[i]);
    if (away && place[0] * away[0] + place[1] * away[1] + place[2] * away[2] > 0) continue;
    found = { depth, place, corners: [a / 3, b / 3, c / 3], value: (1 - u - v) * value[a / 3] + u * value[b / 3] + v * value[c / 3] };
  }
  return found;
};
