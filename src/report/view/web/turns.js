// How a block is turned: quaternions w, x, y, z, and the way from one to the next; turn.rs packs them.

// The three smaller numbers lie between ±1/√2; the highest two bits say which is the largest and left out.
function turnOf(word) {
  const numbers = [20, 10, 0].map((shift) => Math.SQRT1_2 * ((2 * ((word >>> shift) & 1023)) / 1023 - 1));
  const rest = numbers.reduce((left, x) => left - x * x, 1);
  numbers.splice(word >>> 30, 0, Math.sqrt(Math.max(0, rest)));
  return numbers;
}

// Turns by b, then by a.
function turnedBy([a, b, c, d], [e, f, g, h]) {
  return [
    a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g,
    a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e,
  ];
}

// A share of the way between two turns about their common axis, with so many whole rounds beyond the short way.
function partTurn(from, to, rounds, share) {
  const [w, x, y, z] = turnedBy(to, [from[0], -from[1], -from[2], -from[3]]);
  const sign = w < 0 ? -1 : 1;
  const length = Math.hypot(x, y, z);
  if (length < 1e-9) return from;
  const half = share * (Math.atan2(length, sign * w) + Math.PI * rounds);
  const scale = (sign * Math.sin(half)) / length;
  return turnedBy([Math.cos(half), scale * x, scale * y, scale * z], from);
}

// How the block of a path is turned at a time, of which point k is the last before.
function turnAt(paths, path, k, time) {
  const from = turnOf(paths.turn[k]);
  if (k + 1 >= paths.start[path + 1] || time <= paths.time[k]) return from;
  const share = Math.min(1, (time - paths.time[k]) / (paths.time[k + 1] - paths.time[k]));
  const code = paths.rounds[k + 1];
  return partTurn(from, turnOf(paths.turn[k + 1]), (code >>> 1) ^ -(code & 1), share);
}

if (typeof module !== "undefined") module.exports = { turnOf, turnAt };
