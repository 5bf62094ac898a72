// What a page gets from agentface.js: the element <agent-face>, and the parts of it for a scene of one's own.

import { AgentFace } from './element.js';

export { AgentFace };
export { Connection } from './connection.js';
export { Face3D } from './face3d.js';
export { FrameReader } from './frames.js';
export { Player, Recording } from './recording.js';
export { Stage } from './stage.js';

if (!customElements.get('agent-face')) customElements.define('agent-face', AgentFace);
