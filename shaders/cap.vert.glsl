#version 330 core
// The layer on the scalp below the strands: dark, for little light gets there. It moves with the mean of four skin vertices.
#include "frame.glsl"
#include "surface.glsl"
#include "shading.glsl"
#include "develop.glsl"
in ivec4 anchors;
in vec3 offset;        // from the anchors' mean, metres
in vec3 facing;
in vec3 rest;
in vec4 material;      // depth behind the hairline 0..1, ambient light, two spare

centroid out vec3 lit, scalp, rest_position;
centroid out float edge;

uniform vec3 hair_colour, skin_tone;

void main() {
    vec3 mean = 0.25 * (skin_position(anchors.x) + skin_position(anchors.y) + skin_position(anchors.z) + skin_position(anchors.w));
    vec3 n = mat3(head) * facing, light = hemisphere(n) * material.y;
    for (int i = 0; i < LIGHTS; i++) light += light_colour[i].rgb * clamp(0.6 * dot(n, light_direction[i].xyz) + 0.4, 0.0, 1.0) * 0.8;
    lit = finish(hair_colour * light);
    scalp = finish(0.26 * skin_tone * light);
    rest_position = rest;
    edge = material.x;
    gl_Position = view_projection * head * vec4(mean + offset, 1.0);
}
