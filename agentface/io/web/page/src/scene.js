// The parts of a live face for a scene of one's own, without three.js, which that page brings.

export { Connection } from './connection.js';
export { Face3D } from './face3d.js';
export { FrameReader } from './frames.js';
export { Player, Recording } from './recording.js';
