#version 330 core
#include "frame.glsl"
in vec3 place;
in vec3 facing;
in float opening;      // how far it goes with the jaw
in float tint;
uniform mat4 jaw;

out vec3 position, normal;
out float warm;

void main() {
    vec4 at = vec4(place, 1.0), opened = mix(at, jaw * at, opening), placed = head * opened;
    position = placed.xyz;
    normal = mat3(head) * mix(facing, mat3(jaw) * facing, opening);
    warm = tint;
    gl_Position = view_projection * placed;
}
