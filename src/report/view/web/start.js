// Begins: reads the page, fills the card, and waits for hands.

function prepare(gl, canvas, scene) {
  const { terrain, paths, rocks } = scene;
  const hasGround = terrain.place.length > 0;
  const box = hasGround ? terrain.box : paths.place.length > 0 ? boxOf(paths.place) : { low: [0, 0, 0], high: [1, 1, 1] };
  const radius = Array.from(paths.release, (release) => (rocks && rocks.radius_m[release - rocks.first]) || 0.1);
  const moving = new Float32Array(7 * paths.release.length);
  const movingBuffer = buffer(gl, moving, gl.ARRAY_BUFFER, gl.DYNAMIC_DRAW);
  const about = new Float32Array(rocks ? 4 * rocks.stop.length : 0);
  if (rocks) rocks.stop.forEach((stop, k) => {
    const nowhere = stop >= STOP_COLOURS.length;
    about.set([0, nowhere ? 0 : stop, rocks.first + k, nowhere ? 1 : 0], 4 * k);
  });
  return {
    scene, canvas, shown: {}, camera: new Camera(box, cornerstones(hasGround ? terrain.place : paths.place), uphill(scene), canvas.clientWidth / Math.max(1, canvas.clientHeight)), contour: contourStep(box),
    programs: { ground: program(gl, GROUND), line: program(gl, LINE), ball: program(gl, BALL), veil: program(gl, VEIL) },
    mesh: arrays(gl, [[buffer(gl, terrain.place), 3], [buffer(gl, terrain.normal), 3]], buffer(gl, terrain.corners, gl.ELEMENT_ARRAY_BUFFER)),
    pathLines: lineArrays(gl, paths.place, paths.about), walls: wallArrays(gl, scene.walls),
    ends: rocks && arrays(gl, [[buffer(gl, rocks.end), 3], [buffer(gl, about), 4]]),
    balls: arrays(gl, [[movingBuffer, 3, 28, 0], [movingBuffer, 4, 28, 12]]),
    moving, movingBuffer, radius,
    classColours: [...CLASS_COLOURS.flatMap(rgb), ...Array(15).fill(0)],
    layer: -1, texture: null, time: paths.longest, chosen: null, chosenPath: -9,
    labels: scene.walls.map((wall) => {
      const label = made("span", element("names"), wall.name, { title: wall.words });
      label.style.borderColor = wall.height_m === null ? LINE_COLOUR : BARRIER_COLOUR;
      return label;
    }),
  };
}

function player(view, changed) {
  const { longest } = view.scene.paths;
  const [button, slider, clock] = ["play", "time", "clock"].map(element);
  if (longest === 0) for (const one of [button, slider, clock]) one.hidden = true;
  let playing = false, before = 0;
  const show = () => {
    slider.value = String(longest > 0 ? (1000 * view.time) / longest : 1000);
    clock.textContent = `${view.time.toFixed(1)} s`;
    button.textContent = playing ? "❚❚" : "▶";
    if (view.chosen !== null) showCard(view);
  };
  const step = (now) => {
    if (!playing) return;
    view.time = Math.min(longest, view.time + (SPEED * (now - before)) / 1000);
    before = now;
    if (view.time >= longest) playing = false;
    show();
    changed();
    requestAnimationFrame(step);
  };
  const toggle = () => {
    playing = !playing && longest > 0;
    if (playing && view.time >= longest) view.time = 0;
    before = performance.now();
    show();
    if (playing) requestAnimationFrame(step);
  };
  button.addEventListener("click", toggle);
  slider.addEventListener("input", () => {
    playing = false;
    view.time = (longest * Number(slider.value)) / 1000;
    show();
    changed();
  });
  show();
  return toggle;
}

async function begin() {
  const canvas = element("picture");
  const gl = canvas.getContext("webgl2", { antialias: true });
  if (!gl) throw new Error("there is no WebGL 2");
  if (typeof DecompressionStream === "undefined") throw new Error("there is no DecompressionStream");
  const scene = await readScene();
  element("title").textContent = scene.title;
  element("notes").textContent = scene.notes.join(" ");
  const view = prepare(gl, canvas, scene);
  // a small window is for the slope
  element("what").open = window.innerWidth > 640;
  let waiting = false;
  const changed = () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; draw(gl, view); });
  };
  const explained = () => { legend(scene, view.shown, view.layer, view.contour); changed(); };
  const choose = (found) => {
    view.chosen = found ? found.release : null;
    view.chosenPath = found && found.path >= 0 ? found.path : -9;
    showCard(view);
    changed();
  };
  switches(scene, view.shown, explained);
  layerChoice(scene, (number) => {
    view.layer = number;
    if (view.texture) gl.deleteTexture(view.texture);
    view.texture = number >= 0 ? layerTexture(gl, scene.maps, number) : null;
    explained();
  });
  const played = player(view, changed);
  hands(canvas, view.camera, { changed, played, clicked: (x, y) => choose(rockAt(view, x, y)) });
  element("close").addEventListener("click", () => choose(null));
  element("theme").addEventListener("click", () => {
    const dark = getComputedStyle(document.documentElement).colorScheme === "dark";
    document.documentElement.dataset.theme = dark ? "light" : "dark";
    changed();
  });
  window.addEventListener("resize", changed);
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
  canvas.addEventListener("webglcontextlost", () => fail("the graphics card was lost; load the page again"));
  explained();
  draw(gl, view);
  const error = gl.getError();
  if (error) throw new Error(`WebGL error ${error}`);
  document.documentElement.dataset.state = "drawn";
  return { view, choose, changed };
}

begin().catch((why) => fail(why.message));
