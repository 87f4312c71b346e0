// The programs of the graphics card.

const HEAD = "#version 300 es\nprecision highp float;\n";

// Ground and trees: lit from the north-west, contour lines, a map layer on top.
const GROUND = [`${HEAD}
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
uniform mat4 view;
out vec3 at;
out vec3 upright;
void main() {
  at = place;
  upright = normal;
  gl_Position = view * vec4(place, 1.0);
}`, `${HEAD}
in vec3 at;
in vec3 upright;
uniform vec3 eye;
uniform vec3 tint;
uniform float tree;
uniform float contour;
uniform float height;
uniform vec4 box;
uniform float cover;
uniform sampler2D layer;
out vec4 colour;
const vec3 LIGHT = normalize(vec3(-0.5, 0.5, 0.75));
void main() {
  vec3 flat_normal = normalize(cross(dFdx(at), dFdy(at)));
  vec3 n = tree > 0.5 ? flat_normal : normalize(upright);
  if (tree > 0.5 && dot(n, eye - at) < 0.0) n = -n;
  float light = 0.42 + 0.62 * max(dot(n, LIGHT), 0.0);
  vec3 base = tint;
  if (tree < 0.5) base = mix(tint * vec3(0.90, 0.89, 0.90), tint, smoothstep(0.45, 0.85, n.z));
  vec2 cell = (at.xy - box.xy) * box.zw;
  if (cover > 0.0 && all(greaterThanEqual(cell, vec2(0.0))) && all(lessThan(cell, vec2(1.0)))) {
    vec4 over = texture(layer, vec2(cell.x, 1.0 - cell.y));
    base = mix(base, over.rgb, cover * over.a);
  }
  vec3 shade = base * light;
  if (contour > 0.0) {
    float h = (at.z + height) / contour;
    float w = fwidth(h);
    float line = 1.0 - smoothstep(0.3, 1.2, abs(fract(h - 0.5) - 0.5) / max(w, 1e-6));
    float main_line = abs(mod(round(h), 5.0)) < 0.5 ? 0.5 : 0.26;
    shade = mix(shade, shade * 0.45, main_line * line * (1.0 - smoothstep(0.25, 0.6, w)) * step(1e-4, w));
  }
  colour = vec4(shade, 1.0);
}`];

// Lines of a width in pixels: every piece between two points is a rectangle that faces the viewer.
const LINE = [`${HEAD}
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec4 about_from;
layout(location = 3) in vec4 about_to;
uniform mat4 view;
uniform vec2 screen;
uniform float width;
uniform float chosen;
uniform vec3 colours[8];
out vec3 tint;
out float time;
out float is_chosen;
void main() {
  vec4 a = view * vec4(from, 1.0), b = view * vec4(to, 1.0);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  tint = colours[int(about_from.y)];
  bool is_end = gl_VertexID % 2 == 1;
  time = is_end ? about_to.x : about_from.x;
  is_chosen = abs(about_from.z - chosen) < 0.5 ? 1.0 : 0.0;
  if (about_from.w > 0.5 || a.w <= 0.0 || b.w <= 0.0) return;
  vec2 along = b.xy / b.w * screen - a.xy / a.w * screen;
  along = length(along) > 1e-4 ? normalize(along) : vec2(1.0, 0.0);
  vec4 p = is_end ? b : a;
  float side = gl_VertexID < 2 ? -1.0 : 1.0;
  p.xy += side * vec2(-along.y, along.x) * width * (1.0 + 1.2 * is_chosen) / screen * p.w;
  p.z -= (0.0006 + 0.002 * is_chosen) * p.w;
  gl_Position = p;
}`, `${HEAD}
in vec3 tint;
in float time;
in float is_chosen;
uniform float now;
uniform float opacity;
uniform float later;
out vec4 colour;
void main() {
  float strength = is_chosen > 0.5 ? 1.0 : opacity;
  if (time > now) strength *= later;
  if (strength <= 0.0) discard;
  colour = vec4(tint, strength);
}`];

// Rocks and ends: discs that look like balls, never too small to be seen.
const BALL = [`${HEAD}
layout(location = 0) in vec3 place;
layout(location = 1) in vec4 about;
uniform mat4 view;
uniform float per_metre;
uniform float least;
uniform float chosen;
uniform vec3 colours[8];
out vec3 tint;
out float is_chosen;
void main() {
  gl_Position = view * vec4(place, 1.0);
  gl_Position.z -= 0.001 * gl_Position.w;
  tint = colours[int(about.y)];
  is_chosen = abs(about.z - chosen) < 0.5 ? 1.0 : 0.0;
  float size = max(2.0 * about.x * per_metre / gl_Position.w, least);
  gl_PointSize = min(size + 5.0 * is_chosen, 200.0);
  if (about.w > 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`, `${HEAD}
in vec3 tint;
in float is_chosen;
uniform float opacity;
uniform vec3 rim;
out vec4 colour;
void main() {
  vec2 p = 2.0 * gl_PointCoord - 1.0;
  float r = dot(p, p);
  if (r > 1.0) discard;
  vec3 n = vec3(p.x, -p.y, sqrt(1.0 - r));
  float light = 0.55 + 0.5 * max(dot(n, normalize(vec3(-0.5, 0.6, 0.7))), 0.0);
  vec3 shade = r > 0.7 && is_chosen > 0.5 ? rim : tint * light;
  colour = vec4(shade, max(opacity, is_chosen));
}`];

// Curtains of lines and barriers: one colour, seen through.
const VEIL = [`${HEAD}
layout(location = 0) in vec3 place;
uniform mat4 view;
void main() { gl_Position = view * vec4(place, 1.0); gl_Position.z -= 0.0004 * gl_Position.w; }`, `${HEAD}
uniform vec4 paint;
out vec4 colour;
void main() { colour = paint; }`];

// A program with its uniforms by name.
function program(gl, [vertex, fragment]) {
  const whole = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(whole, shader);
  }
  gl.linkProgram(whole);
  if (!gl.getProgramParameter(whole, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(whole));
  const at = {};
  const count = gl.getProgramParameter(whole, gl.ACTIVE_UNIFORMS);
  for (let i = 0; i < count; i++) {
    const name = gl.getActiveUniform(whole, i).name;
    at[name.replace("[0]", "")] = gl.getUniformLocation(whole, name);
  }
  return { whole, at };
}
