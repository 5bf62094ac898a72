#version 330 core
#include "noise.glsl"
#include "develop.glsl"
centroid in vec3 lit, rest_position;
centroid in float edge;
out vec4 colour;

uniform float coils;  // 1: what one sees is the hair itself, 0: it lies below strands

void main() {
    vec4 grain = noise(rest_position * mix(vec3(22.0, 120.0, 170.0), vec3(61.0), coils));   // hair, combed to the sides
    float fine = grain.b, coil = 1.0 - abs(2.0 * grain.a - 1.0);
    float alpha = smoothstep(0.05, 0.95, edge + 0.9 * (fine - 0.5) * (1.0 - edge));
    colour = vec4(lit * mix(1.0, 0.70, coils) * mix(0.75 + 1.1 * fine, 0.25 + 2.6 * coil * coil * (0.5 + fine), coils), blended(alpha));
}
