#version 330 core
#include "noise.glsl"
#include "develop.glsl"
centroid in vec3 lit, scalp, rest_position;
centroid in float edge;
out vec4 colour;

uniform float coils;    // 1: what one sees is the hair itself, 0: it lies below strands
uniform vec4 parting;   // x and z where it begins, x and z where it ends, metres

const vec2 DOTS = vec2(3.0, 2.0);   // of stubble, from grain to grain of hair and of coils
const float PATCHY = 0.65;   // how unevenly coils begin to grow
const float BARE = 0.0009;   // metres to both sides of the parting

void main() {
    vec4 grain = noise(rest_position * mix(vec3(22.0, 120.0, 170.0), vec3(67.0), coils));   // hair, combed to the sides
    float fine = grain.b, coil = 1.0 - abs(2.0 * grain.a - 1.0);
    float soft = smoothstep(0.05, 0.95, edge + 0.9 * (fine - 0.5) * (1.0 - edge));
    float dense = sqrt(max(edge, 0.0)) * (1.0 + mix(0.4, PATCHY, coils) * (grain.r - 0.5)), speck = DOTS.x * fine + DOTS.y * coil;
    float dots = smoothstep(0.86 - 1.3 * dense, 1.24 - 1.3 * dense, abs(2.0 * fract(speck) - 1.0));   // stubble, denser and denser
    dots = dense * mix(clamp(1.3 * dense - 0.05, 0.0, 1.0), dots, clamp(1.2 - 1.4 * fwidth(speck), 0.0, 1.0));   // smaller than a pixel: their mean
    float alpha = mix(soft, max(dots, smoothstep(0.72, 0.90, edge)), coils);   // where the cap is solid nothing shines through
    vec3 hair = 0.70 * lit * mix(0.75 + 1.1 * fine, (0.10 + 3.2 * coil * coil * (0.3 + fine)) * (0.5 + grain.r), coils);
    float way = clamp((parting.y - rest_position.z) / max(parting.y - parting.w, 1e-4), 0.0, 1.0);
    float off = abs(rest_position.x - mix(parting.x, parting.z, way));
    float bare = smoothstep(BARE, 0.2 * BARE, off) * step(parting.w, rest_position.z) * (0.35 + 0.4 * fine);
    colour = vec4(mix(hair, scalp, bare), blended(alpha));
}
