// Prints, for every point of every path, how its block is turned there and a fourth of the way on, as the page finds it.
// node turns.js folder-of-the-page's-scripts view.html
const fs = require("fs");
const { readSection } = require(`${process.argv[2]}/decode.js`);
const { turnAt } = require(`${process.argv[2]}/turns.js`);
const page = fs.readFileSync(process.argv[3], "utf8");

(async () => {
  const [, packed] = page.match(/<script type="text\/plain" id="paths">([^<]*)<\/script>/);
  const { columns } = await readSection(packed);
  const start = [0];
  for (const points of columns.points) start.push(start[start.length - 1] + points);
  const paths = { start, time: columns.time, turn: columns.turn, rounds: columns.rounds };
  for (let path = 0; path + 1 < start.length; path++)
    for (let k = start[path]; k < start[path + 1]; k++) {
      const last = k + 1 === start[path + 1];
      const on = last ? paths.time[k] : paths.time[k] + 0.25 * (paths.time[k + 1] - paths.time[k]);
      console.log([...turnAt(paths, path, k, paths.time[k]), ...turnAt(paths, path, k, on)].join(" "));
    }
})();
