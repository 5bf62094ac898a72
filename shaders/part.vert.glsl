#version 330 core
#include "frame.glsl"
#include "mouth.glsl"
in vec3 place;
in vec3 facing;
in vec4 material;      // tooth, gum, tongue
in vec2 detail;        // on a tooth: across and up
uniform mat4 moved;    // from rest into the scene

centroid out vec3 position, normal, rest_position;
centroid out vec4 matter;
centroid out vec2 within;
centroid out vec3 reach;   // of the surroundings' light and the key light what arrives; how far behind the lips

void main() {
    vec4 placed = moved * vec4(place, 1.0);
    position = placed.xyz;
    normal = mat3(moved) * facing;
    rest_position = place;
    matter = material;
    within = detail;
    vec3 at = transpose(mat3(head)) * (placed.xyz - head[3].xyz);
    reach = vec3(mouth_reach(at), mouth_depth(at));
    gl_Position = view_projection * placed;
}
