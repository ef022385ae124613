// Numbers inside a page, compressed as text by reports/format/packed.py.

const inflated = async (text) => {
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = letters.charCodeAt(i);
  const stream = new Blob([bytes]).stream();
  return new Uint8Array(await new Response(stream.pipeThrough(new DecompressionStream("deflate"))).arrayBuffer());
};

const KINDS = { i1: Int8Array, i2: Int16Array, u1: Uint8Array, u2: Uint16Array, u4: Uint32Array, f4: Float32Array, f8: Float64Array };

// Bytes by their place in a number, and differences of integers.
const numbers = (Type, bytes) => {
  const size = Type.BYTES_PER_ELEMENT, count = bytes.length / size, out = new Uint8Array(bytes.length);
  for (let b = 0; b < size; b++) for (let i = 0; i < count; i++) out[size * i + b] = bytes[b * count + i];
  const found = new Type(out.buffer);
  if (Type !== Float32Array && Type !== Float64Array) for (let i = 1; i < count; i++) found[i] += found[i - 1];
  return found;
};

// Data with all arrays in it unpacked.
const unpacked = async (part) => {
  if (part?.packed) return numbers(KINDS[part.kind], await inflated(part.packed));
  if (Array.isArray(part)) return typeof part[0] === "object" ? Promise.all(part.map(unpacked)) : part;
  if (!part || typeof part !== "object") return part;
  return Object.fromEntries(await Promise.all(Object.entries(part).map(async ([name, value]) => [name, await unpacked(value)])));
};
