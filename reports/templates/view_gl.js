// Draws surfaces with one WebGL context for all views: browsers limit the number of contexts.

const STOPS = ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"]; // viridis
const DECADES = 2; // range of the safety factor scale, upwards from the minimum

const VERTEX = `#version 300 es
in vec3 place, moved, normal;
in float value, excluded;
uniform mat3 turn;
uniform vec3 centre, scale;
uniform float exaggerated;
out vec3 seen, facing;
out float stress, hidden;
void main() {
  seen = turn * (place + exaggerated * moved - centre);
  facing = turn * normal;
  stress = value;
  hidden = excluded;
  gl_Position = vec4(seen * scale, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec3 seen, facing;
in float stress, hidden;
uniform vec3 stops[${STOPS.length}];
uniform float top, decades; // decades > 0: logarithmic scale over so many decades below top
out vec4 colour;
void main() {
  // Without normals, shade each facet flat.
  vec3 n = length(facing) > 0.0 ? normalize(facing) : normalize(cross(dFdx(seen), dFdy(seen)));
  if (n.z < 0.0) n = -n;
  float light = 0.72 + 0.28 * max(dot(n, normalize(vec3(0.25, 0.5, 0.83))), 0.0);
  float part = decades > 0.0 ? 1.0 + log(max(stress / top, 1e-9)) / (2.302585 * decades) : stress / top;
  float x = clamp(part, 0.0, 1.0) * ${(STOPS.length - 1).toFixed(1)};
  int i = min(int(x), ${STOPS.length - 2});
  vec3 c = mix(stops[i], stops[i + 1], x - float(i));
  if (hidden > 0.5) c = vec3(mod(gl_FragCoord.x + gl_FragCoord.y, 10.0) < 5.0 ? 0.58 : 0.74);
  colour = vec4(c * light, 1.0);
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

  // Buffers of a surface: constant ones, and those updated at each instant.
  const upload = (surface) => {
    const array = gl.createVertexArray(), buffers = {};
    gl.bindVertexArray(array);
    for (const [name, size] of [["place", 3], ["normal", 3], ["moved", 3], ["value", 1], ["excluded", 1]]) {
      const at = gl.getAttribLocation(program, name);
      buffers[name] = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, surface.triangles, gl.STATIC_DRAW);
    const set = (name, values) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    };
    set("place", surface.places);
    set("normal", surface.normals);
    return { array, count: surface.triangles.length, set };
  };

  // turn: rows right, up, towards the viewer. scale: length to half the picture size.
  const draw = (shape, width, height, { turn, centre, scale, exaggerated, top, decades }) => {
    canvas.width = width;
    canvas.height = height;
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.bindVertexArray(shape.array);
    gl.uniformMatrix3fv(uniform("turn"), true, turn.flat());
    gl.uniform3fv(uniform("centre"), centre);
    gl.uniform3fv(uniform("scale"), scale);
    gl.uniform1f(uniform("exaggerated"), exaggerated);
    gl.uniform1f(uniform("top"), top);
    gl.uniform1f(uniform("decades"), decades);
    gl.drawElements(gl.TRIANGLES, shape.count, gl.UNSIGNED_INT, 0);
    return canvas;
  };
  return { upload, draw };
};
