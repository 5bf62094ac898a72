#version 330 core
// The skin as a film, by the vertex alone.
#include "frame.glsl"
#include "surface.glsl"
out vec3 position, normal;

void main() {
    vec4 placed = head * vec4(skin_position(gl_VertexID), 1.0);
    position = placed.xyz;
    normal = mat3(head) * skin_normal(gl_VertexID);
    gl_Position = view_projection * placed;
}
