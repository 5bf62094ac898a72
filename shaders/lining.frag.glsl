#version 330 core
// The flesh between a lid and the eyeball: by its corner the white goes on there, flushed and in shade.
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "develop.glsl"
centroid in vec3 normal, rest_position;
centroid in vec4 matter;   // y: 1 at the lid's margin, less behind
out vec4 colour;

uniform vec3 sclera;

const vec3 FLUSHED = vec3(0.90, 0.54, 0.46);   // of the white's colour
const float NEAR = 0.34, FAR = 0.16;           // of the light, what arrives at the margin and behind

void main() {
    vec3 n = normalize(normal), light = hemisphere(n);
    for (int i = 0; i < 2; i++) light += light_colour[i].rgb * wrapped(vec3(dot(n, light_direction[i].xyz)), vec3(0.3));
    colour = vec4(finish(sclera * FLUSHED * (0.85 + 0.30 * noise(rest_position * 150.0).r) * light * mix(FAR, NEAR, matter.y)), 1.0);
}
