#version 330 core
#include "frame.glsl"
#include "surface.glsl"
#include "atlas.glsl"
in ivec2 ends;         // the skin vertices between which this one lies
in vec3 rest;          // at rest, metres
in vec3 soft_normal;   // at rest, blurred
in vec3 rest_normal;
in vec4 material;      // lip, inside of the mouth, wet lid margin, ear
in vec4 complexion;    // redness, eye socket, gloss, under the hair
in float ambient;      // how much of the surroundings' light arrives
in float lit_at_rest;  // how much of the key light arrives at rest

centroid out vec3 position, normal, blurred_normal, rest_position;
centroid out vec4 matter, tint;
centroid out float open_sky, rest_key;
centroid out vec2 atlas;

const float MOUTH_BEHIND = 0.007;  // metres

void main() {
    vec4 placed = head * vec4(edge_position(ends), 1.0);
    vec3 n = edge_normal(ends);
    position = placed.xyz;
    normal = mat3(head) * n;
    blurred_normal = mat3(head) * (soft_normal + 0.6 * (n - rest_normal));
    rest_position = rest;
    atlas = atlas_place(rest);
    matter = material;
    tint = complexion;
    open_sky = ambient;
    rest_key = lit_at_rest;
    gl_Position = view_projection * placed;
    // the inside of the mouth follows the lips less than the lips move: it must not hide the teeth
    vec4 behind = view_projection * vec4(position + MOUTH_BEHIND * material.y * normalize(position - eye_point.xyz), 1.0);
    gl_Position.z = behind.z / behind.w * gl_Position.w;
}
