// Puts it all on the graphics card and draws it.

const SPEED = 1; // seconds of the slope in a second of play
const LEAST_PX = 6;

function fail(why) {
  const box = element("trouble");
  box.hidden = false;
  box.textContent = T("This page cannot be drawn here: {why}. It needs WebGL 2 and a browser of 2023 or newer.", { why: T(why) });
  document.documentElement.dataset.state = `failed: ${why}`;
}

function buffer(gl, data, kind = gl.ARRAY_BUFFER, use = gl.STATIC_DRAW) {
  const one = gl.createBuffer();
  gl.bindBuffer(kind, one);
  gl.bufferData(kind, data, use);
  return one;
}

// An array object of [buffer, size, stride, offset, divisor] by location.
function arrays(gl, parts, corners) {
  const one = gl.createVertexArray();
  gl.bindVertexArray(one);
  parts.forEach(([data, size, stride = 0, offset = 0, divisor = 0], at) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, data);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(at, divisor);
  });
  if (corners) gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, corners);
  gl.bindVertexArray(null);
  return one;
}

// Points one behind the other as pieces of lines; `about` is time, colour, number, last.
function lineArrays(gl, place, about) {
  const [places, facts] = [buffer(gl, place), buffer(gl, about)];
  return {
    pieces: Math.max(0, place.length / 3 - 1),
    arrays: arrays(gl, [[places, 3, 12, 0, 1], [places, 3, 12, 12, 1], [facts, 4, 16, 0, 1], [facts, 4, 16, 16, 1]]),
  };
}

// Foot and upper edge of all lines and barriers, and the veils between.
function wallArrays(gl, walls) {
  const [edge, about, veil] = [[], [], []];
  for (const wall of walls) {
    const colour = wall.height_m === null ? 0 : 1;
    const edges = wall.height_m === null ? [0] : [0, wall.height_m];
    for (const height of edges)
      wall.foot.forEach((p, i) => {
        edge.push(p[0], p[1], p[2] + height);
        about.push(0, colour, -1, i + 1 === wall.foot.length ? 1 : 0);
      });
    if (wall.height_m !== null)
      for (let i = 0; i + 1 < wall.foot.length; i++) {
        const [a, b] = [wall.foot[i], wall.foot[i + 1]];
        const [c, d] = [a, b].map((p) => plus(p, [0, 0, wall.height_m]));
        veil.push(...a, ...b, ...c, ...c, ...b, ...d);
      }
  }
  return {
    edges: lineArrays(gl, new Float32Array(edge), new Float32Array(about)),
    veil: arrays(gl, [[buffer(gl, new Float32Array(veil)), 3]]), corners: veil.length / 3,
  };
}

function layerTexture(gl, maps, number) {
  const classes = maps.columns_of[`layer ${number}`], { limits } = maps.layers[number];
  const pixels = new Uint8Array(4 * classes.length);
  classes.forEach((k, i) => {
    if (k > 0) pixels.set([...rgb(layerColour(k - 1, limits.length)).map((c) => Math.round(255 * c)), 255], 4 * i);
  });
  const one = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, one);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, maps.columns, maps.rows, 0, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  for (const [key, value] of [["MIN_FILTER", "NEAREST"], ["MAG_FILTER", "NEAREST"], ["WRAP_S", "CLAMP_TO_EDGE"], ["WRAP_T", "CLAMP_TO_EDGE"]])
    gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${key}`], gl[value]);
  return one;
}

// Direction to look: up the way that the rocks come down, or up the slope of the terrain.
function uphill(scene) {
  let [x, y] = [0, 0];
  const { place, start } = scene.paths;
  for (let path = 0; path + 1 < start.length; path++) {
    const [from, to] = [3 * start[path], 3 * (start[path + 1] - 1)];
    x += place[from] - place[to];
    y += place[from + 1] - place[to + 1];
  }
  if (x === 0 && y === 0) for (let i = 0; i < scene.terrain.normal.length; i += 3) {
    x -= scene.terrain.normal[i];
    y -= scene.terrain.normal[i + 1];
  }
  return x === 0 && y === 0 ? 0 : Math.atan2(x, y) + 0.35;
}

function draw(gl, view) {
  const { scene, camera, programs, shown, canvas } = view;
  const ratio = Math.min(2, window.devicePixelRatio || 1);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((px) => Math.max(1, Math.round(px * ratio)));
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  gl.viewport(0, 0, width, height);
  const matrix = (view.matrix = camera.matrix(width / height));
  const style = getComputedStyle(document.documentElement);
  const css = (name) => rgb(style.getPropertyValue(name).trim());
  gl.clearColor(...css("--paper"), 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  const use = ({ whole, at }) => {
    gl.useProgram(whole);
    gl.uniformMatrix4fv(at.view, false, matrix);
    return at;
  };
  gl.enable(gl.DEPTH_TEST);
  gl.disable(gl.BLEND);
  drawGround(gl, view, use(programs.ground), css("--ground"));
  gl.enable(gl.BLEND);
  gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  gl.depthMask(false);
  const screen = [width / 2, height / 2];
  if (shown.walls) drawWalls(gl, view, use, screen, ratio);
  if (shown.paths) {
    const at = use(programs.line);
    gl.uniform2fv(at.screen, screen);
    gl.uniform3fv(at.colours, view.classColours);
    gl.uniform1f(at.width, 0.75 * ratio);
    gl.uniform1f(at.chosen, view.chosenPath);
    gl.uniform1f(at.now, view.time);
    gl.uniform1f(at.opacity, view.chosen === null ? 0.62 : 0.22);
    gl.uniform1f(at.later, 0.18);
    drawLine(gl, view.pathLines);
  }
  gl.depthMask(true);
  drawBalls(gl, view, use(programs.ball), { height, ratio });
  furnish(camera, canvas.clientHeight);
  nameWalls(view);
}

const drawLine = (gl, { arrays, pieces }) => {
  gl.bindVertexArray(arrays);
  gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, pieces);
};

function drawGround(gl, { scene, camera, shown, mesh, layer, texture, contour }, at, tint) {
  const { corners, ground } = scene.terrain;
  gl.uniform3fv(at.eye, camera.eye());
  gl.uniform3fv(at.tint, tint);
  gl.uniform1f(at.tree, 0);
  gl.uniform1f(at.contour, shown.contours ? contour : 0);
  gl.uniform1f(at.height, scene.low[2] % (5 * contour));
  gl.uniform1f(at.cover, layer >= 0 ? 0.82 : 0);
  if (scene.maps) {
    const { west_m, north_m, cell_m, columns, rows } = scene.maps;
    const [west, south] = [west_m - scene.low[0], north_m - rows * cell_m - scene.low[1]];
    gl.uniform4f(at.box, west, south, 1 / (columns * cell_m), 1 / (rows * cell_m));
  }
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.uniform1i(at.layer, 0);
  gl.bindVertexArray(mesh);
  gl.drawElements(gl.TRIANGLES, ground, gl.UNSIGNED_INT, 0);
  if (shown.trees) {
    gl.uniform1f(at.tree, 1);
    gl.uniform1f(at.contour, 0);
    gl.uniform1f(at.cover, 0);
    gl.uniform3f(at.tint, 0.42, 0.53, 0.30);
    gl.drawElements(gl.TRIANGLES, corners.length - ground, gl.UNSIGNED_INT, 4 * ground);
  }
}

function drawWalls(gl, { programs, walls }, use, screen, ratio) {
  const veil = use(programs.veil);
  gl.uniform4f(veil.paint, ...rgb(BARRIER_COLOUR), 0.38);
  gl.bindVertexArray(walls.veil);
  gl.drawArrays(gl.TRIANGLES, 0, walls.corners);
  const at = use(programs.line);
  gl.uniform2fv(at.screen, screen);
  gl.uniform3fv(at.colours, [...rgb(LINE_COLOUR), ...rgb(BARRIER_COLOUR), ...Array(18).fill(0)]);
  gl.uniform1f(at.width, 1.3 * ratio);
  gl.uniform1f(at.chosen, -9);
  gl.uniform1f(at.now, 1);
  gl.uniform1f(at.opacity, 1);
  gl.uniform1f(at.later, 1);
  drawLine(gl, walls.edges);
}

function drawBalls(gl, view, at, { height, ratio }) {
  const { scene, camera, shown, time } = view;
  gl.uniform1f(at.per_metre, height / (2 * Math.tan(camera.opening / 2)));
  gl.uniform3fv(at.rim, rgb(CHOSEN_COLOUR));
  if (shown.ends && scene.rocks) {
    gl.uniform3fv(at.colours, [...STOP_COLOURS.flatMap(rgb), ...Array(24 - 3 * STOP_COLOURS.length).fill(0)]);
    gl.uniform1f(at.least, 3.4 * ratio);
    gl.uniform1f(at.opacity, 0.85);
    gl.uniform1f(at.chosen, view.chosen ?? -9);
    gl.bindVertexArray(view.ends);
    gl.drawArrays(gl.POINTS, 0, scene.rocks.stop.length);
  }
  if (shown.rocks) {
    const count = scene.paths.release.length;
    const data = view.moving;
    for (let path = 0; path < count; path++) {
      const { place, k } = placeAt(scene.paths, path, time);
      data.set([...place, view.radius[path], scene.paths.about[4 * k + 1], path, 0], 7 * path);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, view.movingBuffer);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, data);
    gl.uniform3fv(at.colours, view.classColours);
    gl.uniform1f(at.least, LEAST_PX * ratio);
    gl.uniform1f(at.opacity, 1);
    gl.uniform1f(at.chosen, view.chosenPath);
    gl.bindVertexArray(view.balls);
    gl.drawArrays(gl.POINTS, 0, count);
  }
}

// Names of lines and barriers beside their middle, one above the other where they would overlap.
function nameWalls({ scene, shown, matrix, canvas, labels }) {
  const names = scene.walls.map((wall, i) => {
    const middle = wall.foot[Math.floor(wall.foot.length / 2)];
    const spot = shown.walls && middle ? project(matrix, plus(middle, [0, 0, wall.height_m ?? 0]), canvas.clientWidth, canvas.clientHeight) : null;
    labels[i].hidden = !spot;
    return { label: labels[i], spot, width: labels[i].offsetWidth, height: labels[i].offsetHeight };
  });
  for (const { label, spot } of apart(names.filter((name) => name.spot))) {
    Object.assign(label.style, { left: `${spot[0]}px`, top: `${spot[1]}px` });
  }
}

// Names as high as they stand or higher, so that none overlaps another: the lowest stays.
function apart(names) {
  const placed = [];
  for (const name of [...names].sort((a, b) => b.spot[1] - a.spot[1])) {
    let y = name.spot[1];
    const overlaps = (other) => Math.abs(name.spot[0] - other.spot[0]) < (name.width + other.width) / 2 + 2
      && y > other.spot[1] - other.height - 2 && y - name.height < other.spot[1] + 2;
    for (let other = placed.find(overlaps); other; other = placed.find(overlaps)) y = other.spot[1] - other.height - 2;
    placed.push({ ...name, spot: [name.spot[0], y] });
  }
  return placed;
}

// The nearest ball, end or path within some pixels of a place in the picture.
function rockAt({ scene, shown, matrix, canvas, time }, x, y) {
  let best = { far: 12, release: null, path: -1 };
  const offer = (place, release, path, penalty) => {
    const spot = project(matrix, place, canvas.clientWidth, canvas.clientHeight);
    if (!spot) return;
    const far = Math.hypot(spot[0] - x, spot[1] - y) + penalty;
    if (far < best.far) best = { far, release, path };
  };
  const { paths, rocks } = scene;
  for (let path = 0; path + 1 < paths.start.length; path++) {
    if (shown.rocks) offer(placeAt(paths, path, time).place, paths.release[path], path, 0);
    if (shown.paths) for (let k = paths.start[path]; k < paths.start[path + 1]; k++)
      offer([paths.place[3 * k], paths.place[3 * k + 1], paths.place[3 * k + 2]], paths.release[path], path, 3);
  }
  if (shown.ends && rocks) for (let k = 0; k < rocks.stop.length; k++)
    if (rocks.stop[k] < STOP_COLOURS.length) offer([rocks.end[3 * k], rocks.end[3 * k + 1], rocks.end[3 * k + 2]], rocks.first + k, -1, 1);
  if (best.release === null) return null;
  return { release: best.release, path: best.path >= 0 ? best.path : Array.from(paths.release).indexOf(best.release) };
}

function showCard(view) {
  const { scene, chosen, chosenPath, time } = view;
  if (chosen === null) { element("card").hidden = true; return; }
  let instant = null;
  if (chosenPath >= 0) {
    const { place, k } = placeAt(scene.paths, chosenPath, time);
    instant = { place, time: Math.min(time, scene.paths.time[scene.paths.start[chosenPath + 1] - 1]), energy: scene.paths.joule(scene.paths.energy[k]) };
  }
  card(scene, { release: chosen }, instant);
}
