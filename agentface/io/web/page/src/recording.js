// A performance in a file: the same stream as a server's, with the head and the sound beside it.

import { FrameReader } from './frames.js';

const TYPE = 'agentface performance', VERSION = 1;

/**
 * A performance that is played: `duration_s`, `fields` of its frames, the bytes of its `head`, and `frameAt(time)`.
 * In JSON: `type`, `version`, `fields`, `frames` (base64 of gzip of all messages, one behind the other), `head` (likewise) and
 * `sound` (a URL, such as one of data:, or null).
 */
export class Recording {
  /** The performance in the element `#id` of this page, or at a URL. */
  static async load(source) {
    const inside = source.startsWith('#') ? document.querySelector(source) : null;
    const record = inside ? JSON.parse(inside.textContent) : await (await fetch(source)).json();
    if (record.type !== TYPE || record.version !== VERSION) {
      throw new Error(`${source}: expected an ${TYPE} ${VERSION}, got ${record.type} ${record.version}`);
    }
    return new Recording(record, await unpacked(record.head), await unpacked(record.frames));
  }

  constructor({ fields, sound }, head, frames) {
    this.head = head;
    this.sound = sound;
    this.frames = frames;
    this.reader = new FrameReader(fields);
    this.count = Math.floor(frames.byteLength / this.reader.byteLength);
    if (!this.count) throw new Error('a performance: expected a frame, got none');
    this.times = Float64Array.from({ length: this.count }, (_, number) => this.read(number).time_s);
    this.duration_s = this.times[this.count - 1] - this.times[0];
  }

  read(number) {
    const { byteLength } = this.reader;
    return this.reader.read(this.frames.slice(number * byteLength, (number + 1) * byteLength));
  }

  /** The last frame that begins before `time_s` after the first, and its number. */
  frameAt(time_s) {
    const time = this.times[0] + time_s;
    let low = 0, high = this.count;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.times[middle] <= time) low = middle;
      else high = middle;
    }
    return [this.read(low), low];
  }
}

async function unpacked(text) {
  const packed = await (await fetch(`data:application/octet-stream;base64,${text}`)).arrayBuffer();
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}

/** Plays a recording by the sound's clock, or the page's where there is none. */
export class Player extends EventTarget {
  /** `show(frame)` is called for each frame that is new; it is shown at once. */
  constructor(recording, show) {
    super();
    this.recording = recording;
    this.show = show;
    this.audio = recording.sound ? new Audio(recording.sound) : null;
    this.at_s = 0;
    this.number = -1;
    this.paused = true;
    this.seek(0);
  }

  get time_s() {
    if (this.paused) return this.at_s;
    if (this.audio && !this.audio.ended) return this.audio.currentTime;
    return this.at_s + (performance.now() - this.since_ms) / 1000;
  }

  /** Go on from where it stands, from the beginning where it has ended; rejects where the browser allows no sound yet. */
  async play() {
    if (this.at_s >= this.recording.duration_s) this.seek(0);
    if (this.audio) {
      this.audio.currentTime = Math.min(this.at_s, this.audio.duration || this.at_s);
      await this.audio.play();
    }
    this.since_ms = performance.now();
    this.paused = false;
    this.step();
  }

  pause() {
    this.at_s = this.time_s;
    this.paused = true;
    this.audio?.pause();
    cancelAnimationFrame(this.waiting);
  }

  /** Stand at `time_s` seconds from the beginning. */
  seek(time_s) {
    this.at_s = Math.max(0, Math.min(time_s, this.recording.duration_s));
    this.since_ms = performance.now();
    if (this.audio) this.audio.currentTime = this.at_s;
    this.put(this.at_s);
  }

  put(time_s) {
    const [frame, number] = this.recording.frameAt(time_s);
    if (number !== this.number) this.show(frame);
    this.number = number;
  }

  step() {
    const time = this.time_s;
    this.put(time);
    if (time >= this.recording.duration_s) {
      this.pause();
      this.at_s = this.recording.duration_s;
      this.dispatchEvent(new Event('ended'));
    } else if (!this.paused) {
      this.waiting = requestAnimationFrame(() => this.step());
    }
  }
}
