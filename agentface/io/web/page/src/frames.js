// Reads binary messages by the list of fields that the server's hello brought.

const READERS = {
  u8: ['getUint8', 1], i8: ['getInt8', 1], u16: ['getUint16', 2], i16: ['getInt16', 2],
  u32: ['getUint32', 4], i32: ['getInt32', 4], f32: ['getFloat32', 4], f64: ['getFloat64', 8],
};

export const FRAME = 0;
export const AUDIO = 2;
const SOUND_BEGINS = 16;

/**
 * Reads frames of one layout: `fields` of {name, type, count, scale}, little endian, behind a byte that says what comes.
 * Two fields of one name are the first and the second part of the same numbers.
 */
export class FrameReader {
  constructor(fields) {
    const counts = {};
    this.fields = fields.map(({ name, type, count = 1, scale = 1 }) => {
      const [method, size] = READERS[type] ?? [];
      if (!method || !(count >= 1)) throw new Error(`hello: expected a field of a known type, got ${type} of ${name}`);
      const start = counts[name] ?? 0;
      counts[name] = start + count;
      return { name, count, scale, method, size, start };
    });
    this.counts = Object.entries(counts);
    this.byteLength = 1 + this.fields.reduce((sum, field) => sum + field.size * field.count, 0);
  }

  /** The numbers of a frame by field: one alone, or an array of doubles. Throws for a message of another length. */
  read(buffer) {
    if (buffer.byteLength !== this.byteLength) {
      throw new Error(`a frame: expected ${this.byteLength} bytes, got ${buffer.byteLength}`);
    }
    const view = new DataView(buffer);
    const frame = Object.fromEntries(this.counts.map(([name, count]) => [name, new Float64Array(count)]));
    let at = 1;
    for (const { name, count, scale, method, size, start } of this.fields) {
      for (let i = 0; i < count; i++, at += size) {
        frame[name][start + i] = view[method](at, true) * (typeof scale === 'number' ? scale : scale[i]);
      }
    }
    for (const [name, count] of this.counts) if (count === 1) frame[name] = frame[name][0];
    return frame;
  }
}

/**
 * A chunk of sound: `channels`, `rate` in hertz, `start_s` on the frames' clock, `samples` interleaved; none: be silent.
 * Null for what is no sound that a browser can play.
 */
export function readSound(buffer) {
  if (buffer.byteLength < SOUND_BEGINS) return null;
  const view = new DataView(buffer);
  const [channels, rate, start_s] = [view.getUint8(1), view.getUint32(4, true), view.getFloat64(8, true)];
  const count = (buffer.byteLength - SOUND_BEGINS) / 2;
  const sane = channels >= 1 && channels <= 8 && rate >= 4000 && rate <= 192000 && Number.isFinite(start_s);
  if (!sane || !Number.isInteger(count / channels)) return null;
  const samples = Float32Array.from({ length: count }, (_, i) => view.getInt16(SOUND_BEGINS + 2 * i, true) / 32768);
  return { channels, rate, start_s, samples };
}
