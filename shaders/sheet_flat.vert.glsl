#version 330 core
// Hair spread out flat, without light: across the picture a sheet's locks, then cards, from the bottom up their length.
#include "noise.glsl"
centroid out vec3 dull, bright;
centroid out vec4 strand;
centroid out vec3 drift;
out vec2 spread;

uniform float locks;
uniform vec3 dull_colour, bright_colour;   // sRGB

void main() {
    vec2 place = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    strand = vec4(locks * place.x, place.y, 1.0, 1.37);
    spread = strand.xy;
    dull = dull_colour;
    bright = bright_colour;
    drift = noise(vec3(0.23 * strand.x, 0.9 * strand.y, 0.31 * strand.w)).rgb - 0.5;
    gl_Position = vec4(place * 2.0 - 1.0, 0.0, 1.0);
}
