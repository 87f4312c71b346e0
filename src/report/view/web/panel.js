// Switches, legend, the card of a rock, compass and scale.

const element = (id) => document.getElementById(id);

// A text in the language of the page, with what is found in its places.
const WORDS = JSON.parse(element("scene").textContent).words ?? {};
const T = (text, found = {}) => (WORDS[text] ?? text).replace(/\{(\w+)\}/g, (place, name) => found[name] ?? place);

function made(tag, parent, text = "", attributes = {}) {
  const one = Object.assign(document.createElement(tag), attributes);
  one.textContent = text;
  parent.append(one);
  return one;
}

// A number as in print: four digits, thousands apart.
function written(value, digits = 3) {
  if (!Number.isFinite(value)) return "–";
  const power = value === 0 ? 0 : Math.floor(Math.log10(Math.abs(value)));
  const text = value.toFixed(Math.min(6, Math.max(0, digits - 1 - power)));
  const [whole, rest] = text.replace("-", "−").split(".");
  return whole.replace(/\B(?=(\d{3})+$)/g, "\u2009") + (rest ? "." + rest : "");
}

const energyText = (joule, digits = 3) =>
  joule >= 2e3 ? `${written(joule / 1e3, digits)} kJ` : `${written(joule, digits)} J`;

// One switch for every kind of thing that is there.
function switches(scene, shown, changed) {
  const kinds = [
    ["paths", T("paths"), scene.paths.release.length > 0], ["rocks", T("rocks"), scene.paths.release.length > 0],
    ["ends", T("ends"), scene.rocks !== null], ["trees", T("trees"), scene.terrain.corners.length > scene.terrain.ground],
    ["walls", T("lines, nets"), scene.walls.length > 0], ["contours", T("contours"), scene.terrain.ground > 0],
  ];
  for (const [kind, name, there] of kinds) {
    shown[kind] = there;
    if (!there) continue;
    const label = made("label", element("switches"));
    const box = made("input", label, "", { type: "checkbox", checked: true, id: `show-${kind}` });
    label.append(name);
    box.addEventListener("change", () => { shown[kind] = box.checked; changed(); });
  }
}

// The choice of map layers; `chose` gets the number of one, or −1.
function layerChoice(scene, chose) {
  element("layer-choice").hidden = !scene.maps;
  if (!scene.maps) return;
  const select = element("layer");
  made("option", select, T("none"), { value: -1 });
  scene.maps.layers.forEach((layer, i) => made("option", select, T(layer.name), { value: i }));
  select.addEventListener("change", () => chose(Number(select.value)));
}

function legend(scene, shown, layer, contour) {
  const box = element("legend");
  box.replaceChildren();
  const entry = (colour, kind, text) => {
    const row = made("div", box);
    made("i", row, "", { className: kind }).style.background = colour;
    row.append(text);
  };
  const limits = scene.classes_j.map((limit) => energyText(limit, 1));
  if (scene.paths.release.length > 0 && (shown.paths || shown.rocks)) {
    made("h3", box, T("Total energy on the way"));
    entry(CLASS_COLOURS[0], "", T("below {x}", { x: limits[0] }));
    entry(CLASS_COLOURS[1], "", T("{low} to {high}", { low: limits[0], high: limits[1] }));
    entry(CLASS_COLOURS[2], "", T("{x} and more", { x: limits[1] }));
  }
  if (scene.rocks && shown.ends) {
    made("h3", box, T("Ends"));
    const found = new Set(scene.rocks.stop);
    scene.stops.forEach((stop, i) => found.has(i) && entry(STOP_COLOURS[i], "dot", T(STOP_NAMES[stop] ?? stop)));
  }
  if (scene.walls.length > 0 && shown.walls) {
    made("h3", box, T("Lines and barriers"));
    if (scene.walls.some((wall) => wall.height_m === null)) entry(LINE_COLOUR, "", T("line or object"));
    if (scene.walls.some((wall) => wall.height_m !== null)) entry(BARRIER_COLOUR, "field", T("barrier, at its height"));
  }
  if (layer >= 0) {
    const { name, unit, limits } = scene.maps.layers[layer];
    made("h3", box, `${T(name)} (${T(unit)})`);
    for (let k = limits.length; k >= 0; k--) {
      const text = limits.length === 0 ? written(0, 1) : k === 0 ? T("below {x}", { x: written(limits[0], 1) }) : k === limits.length ? T("{x} and more", { x: written(limits[k - 1], 1) }) : T("{low} to {high}", { low: written(limits[k - 1], 1), high: written(limits[k], 1) });
      entry(layerColour(k, limits.length), "field", text);
    }
  }
  if (shown.contours) made("p", box, T("Contours every {x} m.", { x: written(contour, 1) })).style.cssText = "margin:8px 0 0;font-size:12px;color:var(--grey)";
}

// Colour of class k of so many limits: the highest is always the darkest.
const layerColour = (k, limits) => LAYER_COLOURS[LAYER_COLOURS.length - 1 - limits + k];

// The row of a rock; `instant` says where it is now, if its path is there.
function card(scene, row, instant) {
  const { rocks } = scene;
  const box = element("card");
  const release = row.release;
  box.hidden = false;
  box.querySelector("h2").textContent = T("Rock {n}", { n: release });
  const table = box.querySelector("table");
  table.replaceChildren();
  const say = (name, text) => {
    const line = made("tr", table);
    made("td", line, name);
    made("td", line, text);
  };
  const k = rocks ? release - rocks.first : -1;
  if (rocks && k >= 0 && k < rocks.stop.length) {
    say(T("Radius"), `${written(rocks.radius_m[k])} m`);
    say(T("Mass"), `${written(rocks.mass_kg[k])} kg`);
    say(T("Ended"), T(STOP_NAMES[scene.stops[rocks.stop[k]]] ?? "–"));
    say(T("Runout"), `${written(rocks.runout_m[k], 4)} m`);
    say(T("Reach angle"), `${written(rocks.reach_angle_deg[k])}°`);
    say(T("Largest speed"), `${written(rocks.max_speed_m_s[k])} m/s`);
    say(T("Largest total energy"), energyText(rocks.max_total_j[k]));
    say(T("Largest bounce height"), `${written(rocks.max_height_m[k])} m`);
    say(T("Impacts"), rocks.tree_impacts[k] ? T("{n}, {trees} on trees", { n: rocks.impacts[k], trees: rocks.tree_impacts[k] }) : rocks.impacts[k]);
  }
  if (instant) {
    say(T("At {t} s", { t: instant.time.toFixed(1) }), energyText(instant.energy));
    const map = plus(instant.place, scene.low);
    say("x, y", `${map[0].toFixed(1)}, ${map[1].toFixed(1)}`);
    say(T("Height of its centre"), `${map[2].toFixed(1)} m`);
  }
  box.querySelector("p").textContent = T("index {n} in releases.csv; “rockfall run SCENE --only {n}” follows it again.", { n: release });
}

// Turns the needle and writes the length of the bar, which holds at the middle of the picture.
function furnish(camera, height) {
  element("needle").setAttribute("transform", `rotate(${(-camera.azimuth * 180) / Math.PI})`);
  const per_pixel = camera.metresPerPixel(height);
  const wanted = 110 * per_pixel;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const length = [5, 2, 1].map((step) => step * power).find((step) => step <= wanted);
  const bar = element("scale").firstElementChild;
  bar.style.width = `${length / per_pixel}px`;
  bar.textContent = length >= 1000 ? `${length / 1000} km` : length < 1 ? `${+(length * 100).toPrecision(2)} cm` : `${length} m`;
}

// A round distance of contour lines that gives a few dozen.
function contourStep(box) {
  const wanted = (box.high[2] - box.low[2]) / 50;
  if (!(wanted > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= wanted);
}
