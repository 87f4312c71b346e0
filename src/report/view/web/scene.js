// What the page holds, as arrays ready to be drawn. Places are in metres from the low corner of the terrain.

// Okabe and Ito's colours: energy classes, reasons of an end, lines and barriers.
const CLASS_COLOURS = ["#0072b2", "#e69f00", "#d55e00"];
const STOP_COLOURS = ["#333333", "#56b4e9", "#cc79a7", "#b3446c", "#f0e442", "#ffffff"];
const STOP_NAMES = {
  at_rest: "at rest", left_terrain: "left the terrain", time_up: "time up", over_budget: "work spent",
  failed: "failed", not_released: "not released",
};
const LINE_COLOUR = "#7b3294", BARRIER_COLOUR = "#009e73", CHOSEN_COLOUR = "#e0007f";
const LAYER_COLOURS = ["#dcefc0", "#9fd8a0", "#52b69a", "#2a7f9e", "#34508c", "#3b1f5b"];

const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);

async function readScene() {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const section = async (name) => {
    const element = document.getElementById(name);
    return element ? readSection(element.textContent) : null;
  };
  const [terrain, paths, rocks, maps] =
    await Promise.all(["terrain", "paths", "rocks", "maps"].map(section));
  const low = lowCorner(terrain, paths, rocks);
  const here = (frame) => frame.low_m.map((x, i) => x - low[i]);
  const places = (numbers, frame) => metres(numbers, here(frame), frame.quantum_m);
  return {
    ...scene,
    low,
    terrain: groundOf(terrain, places),
    paths: paths ? pathsOf(paths, places, scene.classes_j) : noPaths(),
    rocks: rocks ? rocksOf(rocks, places) : null,
    maps: maps ? { ...maps.facts, columns_of: maps.columns } : null,
    walls: scene.walls.map((wall) => ({ ...wall, foot: wall.foot_m.map((p) => minus(p, low)) })),
  };
}

function lowCorner(...sections) {
  const known = sections.find((section) => section && Object.values(section.columns)[0].length > 0);
  return known ? known.facts.frame.low_m : [0, 0, 0];
}

function groundOf({ facts, columns }, places) {
  const place = places(columns.vertices, facts.frame);
  const corners = cornersOf(columns.corners);
  return { place, corners, ground: 3 * facts.ground, normal: normals(place, corners), box: boxOf(place) };
}

// At every vertex the mean of its triangles, each by its area, all looking up.
function normals(place, corners) {
  const normal = new Float32Array(place.length);
  const at = (v) => [place[3 * v], place[3 * v + 1], place[3 * v + 2]];
  for (let t = 0; t < corners.length; t += 3) {
    const [a, b, c] = [corners[t], corners[t + 1], corners[t + 2]];
    const n = cross(minus(at(b), at(a)), minus(at(c), at(a)));
    const up = n[2] < 0 ? -1 : 1;
    for (const v of [a, b, c]) for (let i = 0; i < 3; i++) normal[3 * v + i] += up * n[i];
  }
  return normal;
}

function boxOf(place) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < place.length; i++) {
    low[i % 3] = Math.min(low[i % 3], place[i]);
    high[i % 3] = Math.max(high[i % 3], place[i]);
  }
  return { low, high };
}

// Some hundreds of places, evenly taken: what a picture of all must hold.
function cornerstones(place) {
  const every = Math.max(1, Math.floor(place.length / 3 / 800));
  const some = [];
  for (let i = 0; i + 2 < place.length; i += 3 * every) some.push([place[i], place[i + 1], place[i + 2]]);
  return some;
}

const noPaths = () => ({
  place: new Float32Array(0), about: new Float32Array(0), time: new Float32Array(0),
  energy: new Uint32Array(0), release: [], start: [0], longest: 0,
});

// Points of all paths one behind the other; `start[k]` is the first of path k.
function pathsOf({ facts, columns }, places, limits) {
  const place = places(columns.place, facts.frame);
  const count = place.length / 3;
  const time = Float32Array.from(columns.time, (ticks) => ticks / facts.ticks_per_s);
  const joule = (code) => 10 ** (code / facts.energy_steps) - 1;
  const start = [0];
  for (const points of columns.points) start.push(start[start.length - 1] + points);
  // of every point: time, class of energy, path, whether it is the last
  const about = new Float32Array(4 * count);
  let longest = 0;
  for (let path = 0; path + 1 < start.length; path++) {
    for (let k = start[path]; k < start[path + 1]; k++) {
      const energy = joule(columns.energy[k]);
      about.set([time[k], limits.filter((limit) => energy >= limit).length, path, 0], 4 * k);
    }
    const last = start[path + 1] - 1;
    about[4 * last + 3] = 1;
    longest = Math.max(longest, time[last]);
  }
  return { place, about, time, energy: columns.energy, joule, release: columns.release, start, longest };
}

function rocksOf({ facts, columns }, places) {
  const floats = (name) => new Float32Array(columns[name].buffer);
  const numbers = {};
  for (const name of ["radius_m", "mass_kg", "runout_m", "reach_angle_deg", "max_speed_m_s", "max_total_j", "max_height_m"])
    numbers[name] = floats(name);
  return {
    first: facts.first, all: facts.all, end: places(columns.end, facts.frame), stop: columns.stop,
    impacts: columns.impacts, tree_impacts: columns.tree_impacts, ...numbers,
  };
}

// Where the rock of a path is at a time, and between which points.
function placeAt(paths, path, time) {
  let low = paths.start[path], high = paths.start[path + 1] - 1;
  const last = high;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (paths.time[middle] <= time) low = middle; else high = middle;
  }
  const point = (k) => [paths.place[3 * k], paths.place[3 * k + 1], paths.place[3 * k + 2]];
  if (low === high || time <= paths.time[low]) return { place: point(low), k: low, over: low === last };
  const share = Math.min(1, (time - paths.time[low]) / (paths.time[high] - paths.time[low]));
  return { place: plus(point(low), minus(point(high), point(low)), share), k: low, over: time >= paths.time[last] };
}
