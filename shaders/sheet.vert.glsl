#version 330 core
// Long hair as a surface, lit at its points; strands and locks are found by pixel.
#include "frame.glsl"
#include "shading.glsl"
#include "hair.glsl"
#include "noise.glsl"
#include "develop.glsl"
in vec3 place;
in vec3 along_rest;
in vec3 facing;
in vec4 sheet;         // across in locks, along 0..1, light that the hair above lets through, a number of its own

centroid out vec3 dull, bright;  // two hairs side by side, whose scales lie at different angles
centroid out vec4 strand;        // as sheet
centroid out vec3 drift;         // how hairs wander, gaps deepen and light changes
out vec2 spread;                 // the first two of strand

uniform vec3 hair_colour;
uniform float gloss;

const float JITTER = 0.11;    // by how much a strand's highlights are shifted to and fro
const vec2 SHINES = vec2(0.65, 1.85);  // how much of the highlights dull and bright hairs have
const vec2 DISORDER = vec2(0.0, 0.13);  // of the length: up to where roots rise at all angles, and from where they lie alike
const float SCATTER = 0.45;   // what they send back of the highlights, as a part of what they scatter
const vec3 COOL = vec3(0.97, 1.0, 1.04), WARM = vec3(1.04, 1.0, 0.95);   // their own hues
const vec2 LOCKS = vec2(0.88, 1.14);   // how much locks send back, beside each other
const float INSIDE = 0.25;    // of the light that falls on it from outside, seen from inside
const float TURNED = -0.35;   // cosine; at its outline hair is still seen from outside

void main() {
    vec3 placed = (head * vec4(place, 1.0)).xyz, along = mat3(head) * along_rest, n = mat3(head) * facing;
    vec3 view = normalize(eye_point.xyz - placed);
    bool inside = dot(n, view) < TURNED;
    n = inside ? -n : n;
    float own = fract(sheet.w * 3.7);
    vec3 base = hair_colour * mix(0.95, 1.7, smoothstep(0.1, 1.0, sheet.y)) * mix(LOCKS.x, LOCKS.y, fract(sheet.w * 5.3));
    float shift = 0.12 * (own - 0.5);
    HairLight light = hair_lights(base, along, n, view, gloss, shift + vec2(-JITTER, JITTER), sheet.z * (inside ? INSIDE : 1.0));
    float order = smoothstep(DISORDER.x, DISORDER.y, sheet.y);
    dull = COOL * finish(light.body + SHINES.x * mix(SCATTER * light.body, light.shine, order));
    bright = WARM * finish(light.body + SHINES.y * mix(SCATTER * light.body, light.other, order));
    strand = sheet;
    spread = sheet.xy;
    drift = noise(vec3(0.23 * sheet.x, 1.7 * sheet.y, 0.31 * sheet.w)).rgb - 0.5;
    gl_Position = view_projection * vec4(placed, 1.0);
}
