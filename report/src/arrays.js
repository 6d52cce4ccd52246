// The numbers of app/page/packed_array.h.

/** The bytes of base64 text. */
function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

export async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The integers whose bytes are stored plane by plane, the lowest first. */
function joinBytes(bytes, count, width) {
  const codes = new Uint32Array(count);
  for (let byte = 0; byte < width; ++byte)
    for (let i = 0; i < count; ++i) codes[i] |= bytes[byte * count + i] << (8 * byte);
  return codes;
}

function fromDifferences(codes, stride) {
  for (let i = 0; i < codes.length; ++i) {
    const difference = codes[i] & 1 ? -((codes[i] + 1) / 2) : codes[i] / 2;
    codes[i] = difference + (i < stride ? 0 : codes[i - stride]);
  }
}

/** Float64Array of the numbers, Uint32Array for integers. */
export async function unpack({ count, width, data, stride, offset, step, log }) {
  const codes = joinBytes(await inflate(bytesOf(data)), count, width);
  fromDifferences(codes, stride);
  if (step === undefined) return codes;
  const values = new Float64Array(count); // by loops: from() with a function is five times slower
  if (log) for (let i = 0; i < count; ++i) values[i] = codes[i] === 0 ? 0 : 10 ** (offset + step * (codes[i] - 1));
  else
    for (let i = 0; i < count; ++i) {
      const value = offset + step * codes[i];
      values[i] = Math.abs(value) <= 0.5000001 * step ? 0 : value; // 0 is within rounding
    }
  return values;
}

/** The text of pack_text(). */
export async function unpackText({ text }) {
  return new TextDecoder().decode(await inflate(bytesOf(text)));
}

/** The same object with every packed array in it unpacked, at any depth. */
export async function unpackAll(value) {
  if (Array.isArray(value)) return Promise.all(value.map(unpackAll));
  if (value === null || typeof value !== "object") return value;
  if (typeof value.data === "string" && "width" in value) return unpack(value);
  const entries = Object.entries(value).map(async ([key, member]) => [key, await unpackAll(member)]);
  return Object.fromEntries(await Promise.all(entries));
}
