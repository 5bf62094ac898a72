#version 330 core
// Knitted cloth with a ribbed collar.
#include "noise.glsl"
#include "develop.glsl"
in vec3 body, rest_position;
in vec2 within;        // turn, metres from the collar
out vec4 colour;

const float RIBBED = 0.014;  // metres of the collar

void main() {
    float ribbed = smoothstep(RIBBED, RIBBED - 0.001, within.y), off = (within.y - RIBBED) / 0.0012;
    float rib = abs(2.0 * fract(44.0 * within.x) - 1.0), seam = max(1.0 - off * off, 0.0);
    float worn = mix(0.92 + 0.16 * noise(rest_position * 90.0).b, 0.70 + 0.45 * rib, ribbed) * (1.0 - 0.45 * seam);
    colour = vec4(finish(body * worn), 1.0);
}
