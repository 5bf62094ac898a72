// The stream of one face from a server: reconnects by itself, keeps the newest frame alone, asks for things.

import { AUDIO, FRAME, FrameReader, readSound } from './frames.js';

const SHORTEST_S = 0.25, LONGEST_S = 5, PATIENCE_S = 15;

/**
 * Events: `hello` (detail: the server's hello), `open`, `closed`, `frame`, `sound` (a chunk), `message` (any other text).
 * `take()` gives the newest frame that was not taken yet, or null.
 */
export class Connection extends EventTarget {
  constructor(url) {
    super();
    this.url = url;
    this.wait = SHORTEST_S;
    this.asked = new Map();
    this.number = 0;
    this.newest = null;
    this.reader = null;
    this.received = 0;
    this.refused = 0;
    this.open();
  }

  open() {
    this.socket = new WebSocket(this.url);
    this.socket.binaryType = 'arraybuffer';
    this.socket.onopen = () => this.tell('open');
    this.socket.onmessage = ({ data }) => (typeof data === 'string' ? this.readText(data) : this.readBytes(data));
    this.socket.onclose = () => this.closed();
  }

  closed() {
    this.reader = this.newest = null;
    for (const { reject } of this.asked.values()) reject(new Error('the connection to the face was lost'));
    this.asked.clear();
    this.tell('closed');
    if (this.ended) return;
    // a page that reloads with many others does not come back with all of them at once
    this.timer = setTimeout(() => this.open(), 1000 * this.wait * (0.75 + 0.5 * Math.random()));
    this.wait = Math.min(2 * this.wait, LONGEST_S);
  }

  readText(text) {
    let message;
    try {
      message = JSON.parse(text);
    } catch {
      return;
    }
    if (message === null || typeof message !== 'object') return;
    if (message.type === 'hello') {
      this.greeted(message);
      return;
    }
    const asked = this.asked.get(message.id);
    if (asked) {
      this.asked.delete(message.id);
      clearTimeout(asked.timer);
      if (message.error) asked.reject(Object.assign(new Error(explained(message.error)), message.error));
      else asked.resolve(message);
    }
    this.tell('message', message);
  }

  greeted(hello) {
    this.newest = this.reader = null;
    try {
      this.reader = new FrameReader(hello.fields);
    } catch (error) {
      this.tell('message', { type: 'error', error: { where: 'hello', expected: 'fields that this page knows', got: error.message } });
      return;
    }
    this.wait = SHORTEST_S;
    this.tell('hello', hello);
  }

  readBytes(buffer) {
    const kind = new Uint8Array(buffer)[0];
    if (kind === FRAME) {
      if (buffer.byteLength !== this.reader?.byteLength) {
        this.refused += 1;
        return;
      }
      this.newest = buffer;
      this.received += 1;
      this.tell('frame');
    } else if (kind === AUDIO) {
      const sound = readSound(buffer);
      if (sound) this.tell('sound', sound);
      else this.refused += 1;
    }
  }

  /** The newest frame since the last time, or null. */
  take() {
    const buffer = this.newest;
    this.newest = null;
    return buffer && this.reader.read(buffer);
  }

  /** Say that frame `number` has been drawn. */
  acknowledge(number) {
    this.send({ ack: number });
  }

  /** Ask for something, as by OSC: its name and arguments; resolves with the server's answer. */
  request(name, args = []) {
    const id = ++this.number;
    return new Promise((resolve, reject) => {
      if (!this.send({ request: name, args, id })) {
        reject(new Error('the face is not connected'));
        return;
      }
      const timer = setTimeout(() => {
        this.asked.delete(id);
        reject(new Error(`no answer to ${name} within ${PATIENCE_S} s`));
      }, 1000 * PATIENCE_S);
      this.asked.set(id, { resolve, reject, timer });
    });
  }

  send(message) {
    if (this.socket.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  /** End it for good. */
  close() {
    this.ended = true;
    clearTimeout(this.timer);
    this.socket.close();
  }

  tell(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}

function explained({ where, expected, got, hint }) {
  return [`${where}: expected ${expected}`, got === undefined ? '' : `, got ${got}`, hint ? `; ${hint}` : ''].join('');
}
