// An eye that circles round a target, and the hands that move it.

const OPENING = (40 * Math.PI) / 180;

class Camera {
  constructor(box, stones, towards, aspect) {
    this.box = box;
    this.stones = stones;
    this.aspect = aspect;
    this.size = Math.max(1e-3, Math.hypot(...minus(box.high, box.low)));
    this.home(towards);
  }

  // Looks uphill at all of it.
  home(towards = this.towards) {
    this.towards = towards;
    this.target = this.box.low.map((x, i) => (x + this.box.high[i]) / 2);
    this.azimuth = towards;
    this.elevation = 0.62;
    this.distance = 0.3 * this.size;
    for (let k = 0; k < 60 && !this.holds(); k++) this.distance *= 1.05;
  }

  // Whether all of it stands in the picture, clear of the title and the player.
  holds() {
    const matrix = this.matrix(this.aspect);
    const inside = (spot) => spot && spot[0] > 0.03 && spot[0] < 0.97 && spot[1] > 0.06 && spot[1] < 0.9;
    return this.stones.every((stone) => inside(project(matrix, stone, 1, 1)));
  }

  axes() {
    const [s, c] = [Math.sin(this.azimuth), Math.cos(this.azimuth)];
    const [se, ce] = [Math.sin(this.elevation), Math.cos(this.elevation)];
    const ahead = [s * ce, c * ce, -se], right = [c, -s, 0];
    return { ahead, right, up: cross(right, ahead) };
  }

  eye() {
    return plus(this.target, this.axes().ahead, -this.distance);
  }

  matrix(aspect) {
    this.aspect = aspect;
    const { ahead, right, up } = this.axes();
    const far = this.distance + 2 * this.size;
    const near = Math.max(this.distance / 200, far / 20000);
    // a narrow window sees as much from side to side as a square one
    const opening = aspect < 1 ? 2 * Math.atan(Math.tan(OPENING / 2) / aspect) : OPENING;
    this.opening = opening;
    return times(perspective(opening, aspect, near, far), lookFrom(this.eye(), right, up, ahead));
  }

  // Metres at the target for a pixel of a picture so high.
  metresPerPixel(height) {
    return (2 * this.distance * Math.tan((this.opening ?? OPENING) / 2)) / height;
  }

  turn(dx, dy) {
    this.azimuth += 0.006 * dx;
    this.elevation = Math.min(1.5707, Math.max(-0.3, this.elevation + 0.006 * dy));
  }

  // Moves the target with the hand, over the map.
  shift(dx, dy, height) {
    const scale = this.metresPerPixel(height);
    const { right } = this.axes();
    const ahead = [Math.sin(this.azimuth), Math.cos(this.azimuth), 0];
    const steep = Math.max(0.35, Math.sin(Math.abs(this.elevation)));
    this.target = plus(plus(this.target, right, -dx * scale), ahead, (dy * scale) / steep);
  }

  zoom(factor) {
    this.distance = Math.min(6 * this.size, Math.max(this.size * 2e-4, this.distance * factor));
  }
}

// Mouse, touch and keys. `changed` is called when the picture must be drawn again, `clicked` with a place on it.
function hands(canvas, camera, { changed, clicked, played }) {
  const fingers = new Map();
  let moved = 0, apart = 0;
  const middle = () => {
    const all = [...fingers.values()];
    return [0, 1].map((i) => all.reduce((sum, finger) => sum + finger[i], 0) / all.length);
  };
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  canvas.addEventListener("pointerdown", (event) => {
    if (fingers.size === 0) moved = 0;
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    try { canvas.setPointerCapture(event.pointerId); } catch { /* a made event has no pointer */ }
    if (fingers.size === 2) apart = spread();
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!fingers.has(event.pointerId)) return;
    const before = middle();
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    const after = middle();
    const [dx, dy] = [after[0] - before[0], after[1] - before[1]];
    moved += Math.abs(dx) + Math.abs(dy);
    if (fingers.size > 1) {
      const now = spread();
      if (apart > 0 && now > 0) camera.zoom(apart / now);
      apart = now;
      camera.shift(dx, dy, canvas.clientHeight);
    } else if (event.buttons & 6 || event.shiftKey) camera.shift(dx, dy, canvas.clientHeight);
    else camera.turn(dx, dy);
    changed();
  });
  const lift = (event) => {
    if (!fingers.delete(event.pointerId)) return;
    const box = canvas.getBoundingClientRect();
    if (event.type === "pointerup" && fingers.size === 0 && moved < 5)
      clicked(event.clientX - box.left, event.clientY - box.top);
  };
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, lift);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoom(Math.exp(Math.min(100, Math.max(-100, event.deltaY)) * 0.0015));
    changed();
  }, { passive: false });
  const keys = {
    ArrowLeft: () => camera.turn(-12, 0), ArrowRight: () => camera.turn(12, 0),
    ArrowUp: () => camera.turn(0, 12), ArrowDown: () => camera.turn(0, -12),
    a: () => camera.shift(40, 0, canvas.clientHeight), d: () => camera.shift(-40, 0, canvas.clientHeight),
    w: () => camera.shift(0, 40, canvas.clientHeight), s: () => camera.shift(0, -40, canvas.clientHeight),
    "+": () => camera.zoom(0.85), "=": () => camera.zoom(0.85), "-": () => camera.zoom(1 / 0.85),
    n: () => { camera.azimuth = 0; }, t: () => { camera.azimuth = 0; camera.elevation = 1.5707; },
    Home: () => camera.home(), h: () => camera.home(),
  };
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || /INPUT|SELECT|BUTTON|SUMMARY/.test(event.target.tagName)) return;
    if (event.key === " ") played();
    else if (keys[event.key]) keys[event.key]();
    else return;
    event.preventDefault();
    changed();
  });
}
