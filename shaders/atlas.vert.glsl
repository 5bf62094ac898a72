#version 330 core
// Spreads the skin at rest over its atlas; the outermost layer of skin stays.
#include "atlas.glsl"
in vec3 rest;
in vec2 corner;  // barycentric coordinates in this triangle

out vec2 share;
flat out int number;

void main() {
    share = corner;
    number = gl_VertexID / 3;
    gl_Position = vec4(2.0 * atlas_place(rest) - 1.0, 1.0 - 8.0 * length(rest.xz), 1.0);
}
