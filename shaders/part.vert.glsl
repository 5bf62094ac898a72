#version 330 core
#include "frame.glsl"
#include "mouth.glsl"
in vec3 place;
in vec3 rest;          // where it lies with the tongue at rest
in vec3 facing;
in vec4 material;      // tooth, gum, tongue; how dark and yellow this tooth is
in vec2 detail;        // on a tooth: across, 1 where the next one meets it, and up
uniform mat4 moved;    // from rest into the scene

centroid out vec3 position, normal, rest_position;
centroid out vec4 matter;   // tooth; how dark and yellow it is; tongue; of the key light what goes round in the mouth
centroid out vec2 within;
centroid out vec4 reach;   // of the surroundings' light and the key light what arrives; how far behind the lips; 0 at their edges .. 1 clear of them

const float ROW_FROM = 0.011, ROW_OVER = 0.012;         // metres, of teeth and gums
const float TONGUE_FROM = 0.018, TONGUE_OVER = 0.009;   // metres, of the tongue, whose tip lies before its throat's shade

void main() {
    vec4 placed = moved * vec4(place, 1.0);
    position = placed.xyz;
    normal = mat3(moved) * facing;
    rest_position = rest;
    matter = material.xwzw;
    within = detail;
    vec3 at = transpose(mat3(head)) * (placed.xyz - head[3].xyz);
    float depth = mouth_depth(at);
    float fade = mouth_fade(at, mix(ROW_FROM, TONGUE_FROM, material.z), mix(ROW_OVER, TONGUE_OVER, material.z));
    matter.w = mouth_round(fade);
    reach = vec4(mix(fade * mouth_reach(at), vec2(1.0), smoothstep(0.0, 0.006, -depth)), depth, mouth_clear(at));   // before the lips it is light
    gl_Position = view_projection * placed;
}
