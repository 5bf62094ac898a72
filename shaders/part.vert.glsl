#version 330 core
#include "frame.glsl"
in vec3 place;
in vec3 facing;
in vec4 material;      // tooth, gum, tongue
in vec2 detail;        // on a tooth: across and up
uniform mat4 moved;    // from rest into the scene

centroid out vec3 position, normal, rest_position;
centroid out vec4 matter;
centroid out vec2 within;

void main() {
    vec4 placed = moved * vec4(place, 1.0);
    position = placed.xyz;
    normal = mat3(moved) * facing;
    rest_position = place;
    matter = material;
    within = detail;
    gl_Position = view_projection * placed;
}
