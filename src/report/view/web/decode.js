// Reads a section of packed columns; the writer and the format are in pack.rs.

// What the two numbers before lead to expect.
function expected(order, one, two) {
  if (order === 0) return 0;
  return order === 1 ? one : (2 * one - two) | 0;
}

// The numbers of one column, item by item.
function takePlanes(column, planes, from) {
  const { count, parts, bytes, order } = column;
  const numbers = new Uint32Array(count * parts);
  const mask = bytes === 4 ? -1 : (1 << (8 * bytes)) - 1;
  for (let part = 0; part < parts; part++) {
    const start = from + part * count * bytes;
    let one = 0, two = 0;
    for (let item = 0; item < count; item++) {
      let code = 0;
      for (let plane = 0; plane < bytes; plane++) code |= planes[start + plane * count + item] << (8 * plane);
      let number = code;
      if (order > 0) number = (expected(order, one, two) + ((code >>> 1) ^ -(code & 1))) & mask;
      const first = one === 0 && two === 0;
      two = first ? number : one;
      one = number;
      numbers[item * parts + part] = number;
    }
  }
  return numbers;
}

// Facts and columns by name, from the unpacked bytes of a section.
function columnsOf(raw) {
  const length = new DataView(raw.buffer, raw.byteOffset).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(raw.subarray(4, 4 + length)));
  const columns = {};
  let from = 4 + length;
  for (const column of head.columns) {
    columns[column.name] = takePlanes(column, raw, from);
    from += column.count * column.parts * column.bytes;
  }
  return { facts: head.facts, columns };
}

// Facts and columns of a section as it stands in the page.
async function readSection(text) {
  const letters = atob(text.trim());
  const packed = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) packed[i] = letters.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return columnsOf(new Uint8Array(await new Response(stream).arrayBuffer()));
}

// Corners of triangles from codes that count back from the vertices seen so far; 0 is a new one.
function cornersOf(codes) {
  const corners = new Uint32Array(codes.length);
  let seen = 0;
  for (let i = 0; i < codes.length; i++) {
    corners[i] = seen - codes[i];
    if (codes[i] === 0) seen++;
  }
  return corners;
}

// Places in metres, from whole numbers of a quantum above a low corner.
function metres(numbers, low, quantum) {
  const places = new Float32Array(numbers.length);
  for (let i = 0; i < numbers.length; i++) places[i] = low[i % 3] + numbers[i] * quantum;
  return places;
}

if (typeof module !== "undefined") module.exports = { readSection, cornersOf, metres };
