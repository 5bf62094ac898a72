#version 330 core
// The layer on the scalp below the strands: dark, for little light gets there.
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "develop.glsl"
centroid in vec3 position, normal, rest_position;
centroid in vec4 matter;   // depth behind the hairline 0..1, ambient light
out vec4 colour;

uniform vec3 hair_colour;

void main() {
    vec3 n = normalize(normal);
    float fine = noise(rest_position * 61.0).b, edge = matter.x;
    vec3 light = hemisphere(n) * matter.y;
    for (int i = 0; i < LIGHTS; i++) light += light_colour[i].rgb * clamp(0.6 * dot(n, light_direction[i].xyz) + 0.4, 0.0, 1.0) * 0.5;
    float alpha = smoothstep(0.05, 0.95, edge + 0.5 * (fine - 0.5) * (1.0 - edge));
    colour = vec4(finish(hair_colour * (0.7 + 0.5 * fine) * light), blended(alpha));
}
