// <agent-face>: a live face in a page.

import { Connection } from './connection.js';
import { Face3D } from './face3d.js';
import { Player, Recording } from './recording.js';
import { SharedClock, Sound } from './sound.js';
import { Stage } from './stage.js';

const STYLE = ':host { display: block; aspect-ratio: 4 / 5; } canvas { display: block; width: 100%; height: 100%; }';
const MAKES_STAGE = ['quality', 'transparent'];
const MAKES_CONNECTION = ['server', 'face', 'look', 'mode', 'token'];

/**
 * Attributes: `server` (where agentface serves, the script's own place when missing), `face`, `look`, `camera`, `quality`,
 * `transparent`, `mode`, `token`, `src` (a recorded performance instead of a server), `muted`.
 * Events: `ready`, `connected`, `disconnected`, `spoken`, `status`, `error`, each with a `detail`; of a recording `recorded`, when it can be
 * played, and `ended`.
 */
export class AgentFace extends HTMLElement {
  static observedAttributes = [...MAKES_STAGE, ...MAKES_CONNECTION, 'camera', 'src', 'muted'];

  constructor() {
    super();
    this.attachShadow({ mode: 'open' });
    this.clock = new SharedClock();
    this.sound = new Sound(this.clock);
    this.drawn = 0;
    this.drawSoon = () => { this.waiting ??= requestAnimationFrame(() => this.draw()); };
    this.unlock = () => this.sound.unlock();
  }

  connectedCallback() {
    this.makeStage();
    this.begin();
    for (const type of ['pointerdown', 'keydown']) document.addEventListener(type, this.unlock);
  }

  disconnectedCallback() {
    for (const type of ['pointerdown', 'keydown']) document.removeEventListener(type, this.unlock);
    this.end();
    this.sound.close();
    this.endStage();
  }

  attributeChangedCallback(name, before, now) {
    if (!this.stage || before === now) return;
    if (name === 'camera') {
      this.stage.look(now || 'front');
      this.drawSoon();
    } else if (name === 'muted') {
      this.sound.muted = now !== null;
    } else if (MAKES_STAGE.includes(name)) {
      const { head } = this;
      this.endStage();
      this.makeStage();
      if (head) this.wear(head.url, head.bytes, head.shown);
    } else {
      this.end();
      this.begin();
    }
  }

  begin() {
    if (this.hasAttribute('src')) this.makePlayer();
    else this.makeConnection();
  }

  /** The face as an object of three.js; null until it is there. */
  get face() {
    return this.stage?.face ?? null;
  }

  /** An emotion by name 0..1, or several as an object; `fade` and `hold` in seconds. */
  setEmotion(emotion, intensity = 1, { fade, hold } = {}) {
    if (typeof emotion === 'object') return this.request('emotions', ...Object.entries(emotion).flat());
    return this.request('emotion', emotion, intensity, ...(fade === undefined ? [] : [fade]), ...(hold === undefined ? [] : [hold]));
  }

  /** Speak; resolves when it has been spoken. */
  async say(text) {
    const spoken = new Promise((resolve) => this.addEventListener('spoken', (event) => resolve(event.detail), { once: true }));
    await this.request('say', text);
    return spoken;
  }

  /** Look at a point in metres, in the head's axes: x to the person's left, y up, z forward. */
  lookAt(x, y, z) {
    return this.request('look_at', x, y, z);
  }

  /** Play the recording of `src` on, or stop it. */
  play() {
    return this.player?.play();
  }

  pause() {
    this.player?.pause();
  }

  /** What the face is doing. */
  async status() {
    const answer = await this.request('status');
    return answer.status ?? answer;
  }

  /** Anything that OSC can ask for: the last part of its address, and its arguments. */
  request(name, ...args) {
    if (!this.connection) return Promise.reject(new Error('this face plays a recording'));
    return this.connection.request(name, args);
  }

  makeStage() {
    const canvas = document.createElement('canvas'), style = document.createElement('style');
    style.textContent = STYLE;
    this.shadowRoot.replaceChildren(style, canvas);
    this.stage = new Stage(canvas, {
      quality: this.getAttribute('quality') ?? 'portrait', transparent: this.hasAttribute('transparent'), keep: this.hasAttribute('keep'),
    });
    this.stage.look(this.getAttribute('camera') || 'front');
    this.sound.muted = this.hasAttribute('muted');
    this.measure = new ResizeObserver(() => {
      this.stage.resize(this.clientWidth, this.clientHeight);
      if (this.face) this.draw();
    });
    this.measure.observe(this);
  }

  endStage() {
    this.measure?.disconnect();
    this.stage?.dispose();
    this.stage = null;
  }

  makeConnection() {
    this.server = new URL(this.getAttribute('server') || new URL('.', import.meta.url), document.baseURI);
    const query = new URLSearchParams();
    for (const name of ['face', 'look', 'mode', 'token']) if (this.getAttribute(name)) query.set(name, this.getAttribute(name));
    const url = new URL(`live?${query}`, this.server);
    url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
    this.connection = new Connection(url);
    this.connection.addEventListener('hello', ({ detail }) => this.greet(detail));
    this.connection.addEventListener('closed', () => this.tell('disconnected'));
    this.connection.addEventListener('sound', ({ detail }) => this.sound.play(detail));
    this.connection.addEventListener('frame', this.drawSoon);
    this.connection.addEventListener('message', ({ detail }) => {
      if (['spoken', 'status', 'error'].includes(detail.type)) this.tell(detail.type, detail);
    });
  }

  async makePlayer() {
    const source = this.getAttribute('src');
    try {
      const recording = await Recording.load(source);
      await this.wear(source, recording.head);
      if (!this.stage || this.getAttribute('src') !== source) return;
      this.player = new Player(recording, (frame) => {
        this.face.show(frame);
        this.head.shown = frame;
        this.drawSoon();
      });
      this.player.addEventListener('ended', () => this.tell('ended'));
      this.tell('recorded', { duration_s: recording.duration_s });
      if (this.hasAttribute('autoplay')) await this.play();
    } catch (error) {
      this.tell('error', { error: { where: 'src', expected: 'a recorded performance', got: String(error) } });
    }
  }

  end() {
    this.connection?.close();
    this.player?.pause();
    this.connection = this.player = null;
    this.clock.clear();
    this.sound.hush();
    cancelAnimationFrame(this.waiting);
    this.waiting = undefined;
  }

  async greet(hello) {
    this.hello = hello;
    this.clock.clear();
    this.tell('connected', hello);
    const url = new URL(hello.head, this.server);
    if (this.getAttribute('token')) url.searchParams.set('token', this.getAttribute('token'));
    if (this.head?.url === url.href) return;
    try {
      const response = await fetch(url);
      if (!response.ok) throw new Error(`${url}: expected the head, got ${response.status} ${response.statusText}`);
      await this.wear(url.href, await response.arrayBuffer());
    } catch (error) {
      this.tell('error', { error: { where: 'head', expected: 'a head from the server', got: String(error) } });
    }
  }

  async wear(url, bytes, shown) {
    const face = await Face3D.read(bytes);
    if (!this.stage) return;
    if (shown) face.show(shown);
    this.head = { url, bytes, shown };
    this.stage.show(face);
    this.tell('ready', { face: face.name, url });
    this.drawSoon();
  }

  draw() {
    this.waiting = undefined;
    if (!this.face) return;
    const frame = this.connection?.take() ?? null;
    if (frame) {
      this.clock.saw(frame.time_s, performance.now() / 1000);
      this.face.show(frame);
      this.head.shown = frame;
    }
    this.stage.draw();
    if (frame) {
      this.drawn += 1;
      this.connection?.acknowledge(frame.frame);
    }
  }

  tell(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}
