// Where a face is looked at from: agentface/view/camera.py.

import { PerspectiveCamera, Vector3 } from 'three';

const NARROWEST = 0.8;

/** A camera whose vertical opening holds, but in pictures narrower than 4:5, which keep the width. */
export class PortraitCamera extends PerspectiveCamera {
  /** Stand where `view` does: `eye` and `target` in metres, `field_of_view` in radians. */
  stand({ eye, target, field_of_view }) {
    this.opening = field_of_view;
    this.distance = new Vector3(...eye).distanceTo(new Vector3(...target));
    this.position.set(...eye);
    this.lookAt(...target);
    this.updateMatrixWorld();
    this.frameFor(this.aspect);
  }

  /** Take in pictures of width over height `aspect`. */
  frameFor(aspect) {
    this.aspect = aspect;
    const half = Math.tan(0.5 * this.opening) * Math.max(1, NARROWEST / aspect);
    this.fov = (360 / Math.PI) * Math.atan(half);
    this.near = 0.2 * this.distance;
    this.far = this.distance + 2;
    this.updateProjectionMatrix();
  }
}

/** The view that an attribute names: `front`, `three-quarter`, `profile`, or `YAW,PITCH` in degrees round the front's target. */
export function viewNamed(views, name) {
  if (views[name]) return views[name];
  const angles = String(name).split(',').map(Number);
  if (angles.length !== 2 || !angles.every(Number.isFinite)) return views.front;
  const { eye, target, field_of_view } = views.front;
  const distance = Math.hypot(...eye.map((place, axis) => place - target[axis]));
  const yaw = (angles[0] * Math.PI) / 180, pitch = (Math.max(-85, Math.min(85, angles[1])) * Math.PI) / 180;
  const arm = [Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)];
  return { eye: target.map((place, axis) => place + distance * arm[axis]), target, field_of_view };
}
