#version 330 core
// An eyeball seen from the front, without light: a texture whose bottom row is the lowest.
#include "noise.glsl"
#include "srgb.glsl"
#include "eye_paint.glsl"
in vec2 place;
out vec4 colour;

uniform float inset;   // of the picture's half side, the eyeball's radius

void main() {
    vec2 at = (2.0 * place - 1.0) / inset;
    float side = length(at);
    vec3 local = vec3(at * min(1.0, 1.0 / side), 1.0);
    colour = vec4(to_srgb(clamp(mix(white_colour(local.xy), iris_colour(at), iris_cover(local)), 0.0, 1.0)), 1.0);
}
