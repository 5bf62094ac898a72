// The atlas of the face at rest: azimuth about the head's vertical axis, and height.
uniform vec2 atlas_height;  // metres: bottom and top

const float ATLAS_AZIMUTH = 1.35;  // rad, to both sides of the middle

vec2 atlas_place(vec3 rest) {
    float azimuth = atan(rest.x, rest.z);
    return vec2(0.5 + 0.5 * azimuth / ATLAS_AZIMUTH, (rest.y - atlas_height.x) / (atlas_height.y - atlas_height.x));
}
