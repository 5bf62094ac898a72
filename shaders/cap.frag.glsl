#version 330 core
// Hair that covers the scalp as one surface, with strands drawn on it.
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "hair.glsl"
centroid in vec3 position, normal, rest_position;
centroid in vec4 matter;   // strand, place along it, depth behind the hairline 0..1, ambient light
out vec4 colour;

uniform vec3 hair_colour;
uniform vec3 knot;         // where tied hair runs to, at rest
uniform float cropped;     // 1: short curls, 0: combed strands
uniform float grey;

void main() {
    vec3 view = normalize(eye_point.xyz - position), n = normalize(normal);
    float edge = matter.z;
    vec3 along, base;
    float strand, alpha, spread;
    if (cropped > 0.5) {
        const mat3 askew = mat3(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
        vec4 curl = noise(askew * rest_position * 43.0), fleck = noise(askew * rest_position.zxy * 97.0);
        strand = clamp(0.5 + 0.9 * (curl.r - 0.5) + 0.9 * (fleck.g - 0.5), 0.0, 1.0);
        n = normalize(n + 0.9 * (vec3(curl.rg, fleck.r) - 0.5));
        along = normalize(cross(n, vec3(fleck.rg, curl.g + 0.2) - 0.5));
        base = hair_colour * (0.65 + 0.7 * strand);
        base = mix(base, vec3(0.10, 0.098, 0.095), grey * smoothstep(0.42, 0.68, fleck.r));
        alpha = smoothstep(0.0, 0.75, edge + 0.8 * (strand - 0.5) * smoothstep(1.0, 0.3, edge));
        spread = 0.0;
    } else {
        vec3 flow = normalize(knot - rest_position);
        flow = normalize(flow - n * dot(flow, n));
        vec4 wide = noise(vec3(matter.x * 2.2, matter.y * 0.10, 0.1)), fine = noise(vec3(matter.x * 9.0, matter.y * 0.22, 0.4));
        strand = 0.5 * wide.r + 0.5 * fine.b;
        vec3 across = cross(n, flow);
        n = normalize(n + across * ((fine.b - 0.5) * 0.9 + (wide.a - 0.5) * 0.7));
        along = normalize(mat3(head) * flow + 0.3 * n * (fine.a - 0.5));
        base = hair_colour * (0.35 + 1.3 * strand);
        alpha = smoothstep(0.0, 0.22, edge - 0.30 * (0.7 * fine.a + 0.3 * wide.b) * smoothstep(0.6, 0.0, edge));
        spread = 0.20 * (wide.g - 0.5);
    }
    float cover = mix(0.65, 1.0, matter.w);
    vec3 c = hair_light(base, along, n, view, mix(0.8, 0.15, cropped) * (0.4 + 1.2 * strand), spread, cover);
    colour = vec4(c, alpha);
}
