// The sound of speech, in time with the frames: both have times on one clock, the server's.

const LATE_S = 0.02;
const SEAM_S = 0.005;   // pieces that are less apart are one sound
const REMEMBERED = 240;

/** Where the frames' clock stands on the page's: frames that came quickest say it. */
export class SharedClock {
  constructor() {
    this.offsets = [];
  }

  /** A frame of the time `time_s` came at `now_s`. */
  saw(time_s, now_s) {
    this.offsets.push(now_s - time_s);
    if (this.offsets.length > REMEMBERED) this.offsets.shift();
  }

  /** The page's time of the frames' time, in s; null before the first frame. */
  local(time_s) {
    return this.offsets.length ? time_s + Math.min(...this.offsets) : null;
  }

  clear() {
    this.offsets = [];
  }
}

/** Plays chunks. A page may make no sound before its visitor has done something: `locked` says so. */
export class Sound {
  constructor(clock) {
    this.clock = clock;
    this.context = null;
    this.playing = new Set();
    this.muted = false;
    this.end = { sent_s: -Infinity, heard_s: -Infinity };
  }

  get locked() {
    return this.context !== null && this.context.state === 'suspended';
  }

  /** Let it sound: called when the visitor has done something. */
  unlock() {
    return this.context?.resume();
  }

  /** Play a chunk when its time comes; one without samples silences what has not been heard. */
  play({ channels, rate, start_s, samples }) {
    if (samples.length === 0) {
      this.hush();
      return;
    }
    if (this.muted) return;
    this.context ??= new AudioContext({ latencyHint: 'interactive' });
    const local = this.clock.local(start_s);
    if (local === null || this.locked) {
      this.context.resume();
      return;
    }
    const count = samples.length / channels;
    const buffer = this.context.createBuffer(channels, count, rate);
    for (let channel = 0; channel < channels; channel++) {
      const row = buffer.getChannelData(channel);
      for (let i = 0; i < count; i++) row[i] = samples[i * channels + channel];
    }
    const now = this.context.currentTime, heard = this.context.outputLatency || this.context.baseLatency || 0;
    const follows = Math.abs(start_s - this.end.sent_s) < SEAM_S && this.end.heard_s > now;
    const at = follows ? this.end.heard_s : now + (local - performance.now() / 1000) - heard;
    const late = now - at;
    this.end = { sent_s: start_s + buffer.duration, heard_s: at + buffer.duration };
    if (late > buffer.duration) return;
    const source = this.context.createBufferSource();
    source.buffer = buffer;
    source.connect(this.context.destination);
    source.onended = () => this.playing.delete(source);
    source.start(Math.max(at, now), late > LATE_S ? late : 0);
    this.playing.add(source);
  }

  hush() {
    for (const source of this.playing) source.stop();
    this.playing.clear();
  }

  close() {
    this.hush();
    this.context?.close();
    this.context = null;
  }
}
