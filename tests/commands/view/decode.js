// Reads a view with the page's own decoder and prints what a test compares: a sum over every column, places in metres.
// node decode.js decode.js-of-the-page view.html
const fs = require("fs");
const { readSection, cornersOf, metres } = require(process.argv[2]);
const page = fs.readFileSync(process.argv[3], "utf8");

function text(name) {
  const found = page.match(new RegExp(`<script type="text/plain" id="${name}">([^<]*)</script>`));
  return found && found[1];
}

// A sum in which every number counts with its place.
function sum(numbers) {
  let all = 0;
  numbers.forEach((number, i) => { all = (Math.imul(all, 31) + number + i) | 0; });
  return all >>> 0;
}

(async () => {
  for (const name of ["terrain", "paths", "blocks", "rocks", "maps"]) {
    const packed = text(name);
    if (!packed) continue;
    const { columns, facts } = await readSection(packed);
    for (const column of Object.keys(columns)) console.log(name, column.replace(" ", "_"), columns[column].length, sum(columns[column]));
    if (name === "terrain") {
      const corners = cornersOf(columns.corners);
      const low = [0, 0, 0];
      const place = metres(columns.vertices, low, facts.frame.quantum_m);
      const last = corners.length - 1;
      console.log("corner", sum(corners), ...[0, 1, 2].map((i) => place[3 * corners[last] + i].toFixed(3)));
    }
  }
})();
