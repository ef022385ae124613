// Draws surfaces with one WebGL context for all views: browsers limit the number of contexts.

const DECADES = 2; // range of the safety factor scale, upwards from the minimum
const ZONES = 64; // excluded circles at most

const VERTEX = `#version 300 es
in vec3 place, moved, normal;
in float value, excluded;
uniform mat3 turn;
uniform vec3 middle, scale, away;
uniform float exaggerated;
out vec3 seen, facing;
out vec2 meridian;
out float stress, hidden, beyond;
void main() {
  seen = turn * (place + exaggerated * moved - middle);
  facing = turn * normal;
  stress = value;
  hidden = excluded;
  beyond = dot(place, away);
  meridian = vec2(length(place.xy), place.z);
  gl_Position = vec4(seen * scale, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec3 seen, facing;
in vec2 meridian;
in float stress, hidden, beyond;
uniform vec3 stops[${STOPS.length}];
uniform vec3 zones[${ZONES}]; // r, z, distance
uniform int count;
uniform vec2 levels; // lines of equal stress
uniform float top, decades, stripe; // decades > 0: logarithmic scale over so many decades below top
out vec4 colour;
void main() {
  if (beyond > 0.0) discard;
  // Without normals, shade each facet flat.
  vec3 n = length(facing) > 0.0 ? normalize(facing) : normalize(cross(dFdx(seen), dFdy(seen)));
  if (n.z < 0.0) n = -n;
  float light = 0.72 + 0.28 * max(dot(n, normalize(vec3(0.25, 0.5, 0.83))), 0.0);
  float part = decades > 0.0 ? 1.0 + log(max(stress / top, 1e-9)) / (2.302585 * decades) : stress / top;
  float x = clamp(part, 0.0, 1.0) * ${(STOPS.length - 1).toFixed(1)};
  int i = min(int(x), ${STOPS.length - 2});
  vec3 c = mix(stops[i], stops[i + 1], x - float(i)) * light;
  vec2 off = abs(levels - stress) / max(fwidth(stress), 1e-6 * top);
  if (min(off.x, off.y) < 0.75) c = vec3(off.x < off.y ? 0.0 : 1.0);
  bool left_out = hidden > 0.5;
  for (int k = 0; k < count; k++) left_out = left_out || distance(meridian, zones[k].xy) < zones[k].z;
  if (left_out) c = vec3(mod(gl_FragCoord.x + gl_FragCoord.y, 2.0 * stripe) < stripe ? 0.35 : 0.85) * light;
  colour = vec4(c, 1.0);
}`;

// null if the browser has no WebGL 2.
const painter = () => {
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: true });
  if (!gl) return null;
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  const uniform = (name) => gl.getUniformLocation(program, name);
  gl.uniform3fv(uniform("stops"), STOPS.flatMap((s) => [1, 3, 5].map((k) => parseInt(s.slice(k, k + 2), 16) / 255)));

  // Buffers of a mesh: `set` changes those of one name.
  const upload = (mesh) => {
    const array = gl.createVertexArray(), buffers = {};
    gl.bindVertexArray(array);
    for (const [name, size] of [["place", 3], ["normal", 3], ["moved", 3], ["value", 1], ["excluded", 1]]) {
      const at = gl.getAttribLocation(program, name);
      buffers[name] = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array((size * mesh.places.length) / 3), gl.DYNAMIC_DRAW);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
    }
    const numbers = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, numbers);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, mesh.triangles, gl.STATIC_DRAW);
    const set = (name, values) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    };
    const drop = () => {
      Object.values(buffers).forEach((buffer) => gl.deleteBuffer(buffer));
      gl.deleteBuffer(numbers);
      gl.deleteVertexArray(array);
    };
    set("place", mesh.places);
    set("normal", mesh.normals);
    return { array, count: mesh.triangles.length, set, drop };
  };

  // turn: rows right, up, towards the viewer. scale: length to half the picture size. shapes: with
  // `away`, the normal of the plane beyond which each is cut off.
  const draw = (shapes, width, height, { turn, middle, scale, exaggerated, top, decades, zones, levels, stripe }) => {
    canvas.width = width;
    canvas.height = height;
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix3fv(uniform("turn"), true, turn.flat());
    gl.uniform3fv(uniform("middle"), middle);
    gl.uniform3fv(uniform("scale"), scale);
    gl.uniform2fv(uniform("levels"), levels);
    for (const [name, value] of Object.entries({ exaggerated, top, decades, stripe })) gl.uniform1f(uniform(name), value);
    gl.uniform1i(uniform("count"), Math.min(zones.length, ZONES));
    if (zones.length) gl.uniform3fv(uniform("zones"), zones.slice(0, ZONES).flat());
    for (const [shape, away] of shapes) {
      gl.uniform3fv(uniform("away"), away);
      gl.bindVertexArray(shape.array);
      gl.drawElements(gl.TRIANGLES, shape.count, gl.UNSIGNED_INT, 0);
    }
    return canvas;
  };
  return { upload, draw };
};
