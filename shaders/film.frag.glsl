#version 330 core
// Skin that bone is seen through: clear in the middle, dense at its edge.
#include "frame.glsl"
#include "shading.glsl"
#include "develop.glsl"
in vec3 position, normal;
out vec4 colour;

uniform vec3 skin_tone;

void main() {
    vec3 view = normalize(eye_point.xyz - position), n = normalize(normal), light = hemisphere(n);
    for (int i = 0; i < LIGHTS; i++) light += light_colour[i].rgb * wrapped(vec3(dot(n, light_direction[i].xyz)), vec3(0.3));
    float edge = 1.0 - abs(dot(n, view));
    colour = vec4(finish(skin_tone * light), mix(0.14, 0.75, edge * edge * edge));
}
