// Blocks: their hulls, moved and turned. This part stands in pages with blocks only, and goes round the functions that read,
// prepare and draw a scene of balls.

const BLOCK = [`${HEAD}
layout(location = 0) in vec3 corner;
uniform mat4 view;
uniform vec3 centre;
uniform vec4 turn;
uniform float size;
uniform float nearer;
out vec3 at;
void main() {
  vec3 p = corner * size;
  vec3 across = cross(turn.yzw, p);
  at = p + 2.0 * (turn.x * across + cross(turn.yzw, across));
  gl_Position = view * vec4(centre + at, 1.0);
  gl_Position.z -= nearer * gl_Position.w;
}`, `${HEAD}
in vec3 at;
uniform vec3 tint;
uniform vec3 rim;
uniform float is_chosen;
out vec4 colour;
void main() {
  vec3 n = normalize(cross(dFdx(at), dFdy(at)));
  float light = 0.5 + 0.6 * max(dot(n, normalize(vec3(-0.5, 0.5, 0.75))), 0.0);
  colour = vec4(mix(tint, rim, 0.6 * is_chosen) * light, 1.0);
}`];

// All hulls one behind the other, in radii; `first` and `count` of their corners, `of` by release.
function hullsOf({ facts, columns }) {
  const place = Float32Array.from(columns.vertex, (step) => (step - facts.centre) / facts.steps_per_radius);
  const corners = columns.corner.slice();
  const first = [], count = [];
  let [vertex, corner] = [0, 0];
  columns.triangles.forEach((triangles, hull) => {
    first.push(corner);
    count.push(3 * triangles);
    for (let k = 0; k < 3 * triangles; k++) corners[corner + k] += vertex;
    corner += 3 * triangles;
    vertex += columns.vertices[hull];
  });
  return { place, corners, first, count, of: new Map(Array.from(columns.release, (release, i) => [release, columns.hull[i]])) };
}

const pathsOfBalls = pathsOf;
pathsOf = (section, ...rest) => ({
  ...pathsOfBalls(section, ...rest), turn: section.columns.turn, rounds: section.columns.rounds,
});

const readBalls = readScene;
readScene = async () => {
  const [scene, section] = await Promise.all([readBalls(), readSection(element("blocks").textContent)]);
  return { ...scene, hulls: hullsOf(section) };
};

const prepareBalls = prepare;
prepare = (gl, canvas, scene) => {
  const { place, corners, of } = scene.hulls;
  return {
    ...prepareBalls(gl, canvas, scene),
    block: program(gl, BLOCK),
    hulls: arrays(gl, [[buffer(gl, place), 3]], buffer(gl, corners, gl.ELEMENT_ARRAY_BUFFER)),
    hullOf: Array.from(scene.paths.release, (release) => of.get(release)),
  };
};

const drawAllAsBalls = drawBalls;
drawBalls = (gl, view, at, size) => {
  drawAllAsBalls(gl, { ...view, shown: { ...view.shown, rocks: false } }, at, size);
  if (!view.shown.rocks) return;
  const { scene, time, moving } = view;
  const blocks = [];
  let balls = 0;
  for (let path = 0; path < scene.paths.release.length; path++) {
    const { place, k } = placeAt(scene.paths, path, time);
    const kind = scene.paths.about[4 * k + 1];
    if (view.hullOf[path] === undefined) moving.set([...place, view.radius[path], kind, path, 0], 7 * balls++);
    else blocks.push({ path, place, kind, turn: turnAt(scene.paths, path, k, time) });
  }
  gl.bindBuffer(gl.ARRAY_BUFFER, view.movingBuffer);
  gl.bufferSubData(gl.ARRAY_BUFFER, 0, moving);
  gl.uniform3fv(at.colours, view.classColours);
  gl.uniform1f(at.least, LEAST_PX * size.ratio);
  gl.uniform1f(at.opacity, 1);
  gl.uniform1f(at.chosen, view.chosenPath);
  gl.bindVertexArray(view.balls);
  gl.drawArrays(gl.POINTS, 0, balls);
  drawBlocks(gl, view, blocks, size);
};

function drawBlocks(gl, { scene, camera, matrix, block, hulls, hullOf, radius, classColours, chosenPath }, blocks, { height, ratio }) {
  const { whole, at } = block;
  const { first, count } = scene.hulls;
  const metres_per_pixel = (2 * Math.tan(camera.opening / 2)) / height;
  gl.useProgram(whole);
  gl.uniformMatrix4fv(at.view, false, matrix);
  gl.uniform3fv(at.rim, rgb(CHOSEN_COLOUR));
  gl.bindVertexArray(hulls);
  for (const { path, place, kind, turn } of blocks) {
    const depth = matrix[3] * place[0] + matrix[7] * place[1] + matrix[11] * place[2] + matrix[15];
    // never too small to be seen; a block made larger than it is would be half hidden where it lies
    const least = 0.5 * LEAST_PX * ratio * metres_per_pixel * depth;
    const hull = hullOf[path];
    gl.uniform3fv(at.centre, place);
    gl.uniform4fv(at.turn, turn);
    gl.uniform1f(at.size, Math.max(radius[path], least));
    gl.uniform1f(at.nearer, radius[path] < least ? 0.001 : 0);
    gl.uniform3fv(at.tint, classColours.slice(3 * kind, 3 * kind + 3));
    gl.uniform1f(at.is_chosen, path === chosenPath ? 1 : 0);
    gl.drawElements(gl.TRIANGLES, count[hull], gl.UNSIGNED_INT, 4 * first[hull]);
  }
}
