#version 330 core
// The key light's picture of depths.
#include "frame.glsl"
#include "surface.glsl"
in ivec2 ends;

void main() {
    gl_Position = shadow_projection * (head * vec4(edge_position(ends), 1.0));
}
