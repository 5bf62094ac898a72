// Reads the head's file: a binary glTF whose extension AGENTFACE_face names its arrays.

const EXTENSION = 'AGENTFACE_face';
const VERSION = 1;
const KINDS = {
  f32: Float32Array, i32: Int32Array, u32: Uint32Array, i16: Int16Array, u16: Uint16Array, i8: Int8Array, u8: Uint8Array,
};

/**
 * The record that `buffer`, an ArrayBuffer of a GLB file, holds: plain values, and typed arrays with a `shape`.
 * What is stored with a scale comes as Float32Array.
 */
export function readHead(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < 28 || view.getUint32(0, true) !== 0x46546c67) throw new Error('the head: expected a binary glTF file');
  const length = view.getUint32(12, true);
  const document = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 20, length)));
  const record = document.extensions?.[EXTENSION];
  if (record?.version !== VERSION) {
    throw new Error(`the head: expected ${EXTENSION} ${VERSION}, got ${record?.version}; page and server are of two versions`);
  }
  const arrays = record.arrays.map((row) => arrayOf(buffer, 28 + length, document.bufferViews[row.view], row));
  return resolved(record, arrays);
}

function arrayOf(buffer, start, place, { type, shape, scale }) {
  const Kind = KINDS[type];
  const count = shape.reduce((product, side) => product * side, 1);
  if (!Kind || count * Kind.BYTES_PER_ELEMENT !== place.byteLength) throw new Error(`the head: an array of ${type} does not fill its view`);
  let array = new Kind(buffer, start + place.byteOffset, count);
  if (scale !== undefined) array = Float32Array.from(array, (number) => number * scale);
  array.shape = shape;
  return array;
}

function resolved(value, arrays) {
  if (Array.isArray(value)) return value.map((item) => resolved(item, arrays));
  if (value === null || typeof value !== 'object') return value;
  if ('array' in value) return arrays[value.array];
  return Object.fromEntries(Object.entries(value).filter(([key]) => key !== 'arrays').map(([key, item]) => [key, resolved(item, arrays)]));
}
