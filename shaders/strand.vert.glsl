#version 330 core
// A point of a strand of hair: moved with the skin at its root, lit, widened to a ribbon that faces the camera.
#include "frame.glsl"
#include "surface.glsl"
#include "shading.glsl"
#include "hair.glsl"
#include "develop.glsl"
in int anchor;         // the skin vertex it moves with
in vec3 offset;        // from there, metres
in vec3 along_rest;
in vec3 stroke;        // place along the strand 0..1, radius in metres, light that the hair above lets through
in vec4 paint;         // colour and opacity
in float side;         // -1 or 1

centroid out vec3 dull, bright;  // between and on the highlights
centroid out vec4 place;         // across -1..1, along 0..1, a number of its own, opacity or how strong its streaks are

uniform vec3 hair_centre;  // of the head, in the model's axes
uniform float narrowest;   // pixels; a thinner strand fades instead
uniform float gloss;
uniform float solid;       // 1: a lock that hides what is behind it, 0: a hair that fades at its sides
uniform vec2 lift;         // metres that locks are nearer than they are, over their light; without light
uniform float streaks;     // how many hairs are seen on a lock

void main() {
    vec3 rest = skin_position(anchor) + offset;
    vec3 placed = (head * vec4(rest, 1.0)).xyz, along = mat3(head) * along_rest;
    vec3 outward = rest - hair_centre;
    outward.y = max(outward.y, -0.25 * length(outward.xz));
    vec3 n = mat3(head) * normalize(outward);
    vec3 towards = eye_point.xyz - placed, view = normalize(towards);
    float own = fract(paint.r * 3571.0 + float(anchor) * 0.618);

    float t = stroke.x, pixels = stroke.y * eye_point.w / length(towards);
    float taper = mix(1.0 - smoothstep(0.62, 1.02, t), 1.0 - 0.96 * smoothstep(0.62, 1.0, t), solid) * mix(0.08, 1.0, smoothstep(0.0, 0.12, t));
    float widened = max(1.0, narrowest / max(pixels * taper, 1e-4));
    // the head hides its far side, though not what hangs below it
    float seen = dot(n, view) < -0.3 && rest.y > hair_centre.y - 0.03 ? 0.0 : 1.0;
    // a lock lies on the head, a hair is round
    vec3 sideways = normalize(cross(along, view + solid * n));
    placed += sideways * side * seen * stroke.y * taper * widened;

    vec3 base = paint.rgb * mix(1.0, 1.2, smoothstep(0.4, 1.0, t));
    vec3 round = normalize(n + 0.45 * solid * side * sideways);
    HairLight light = hair_lights(base, along, round, view, gloss, vec2(0.16 * (own - 0.5)), stroke.z);
    dull = finish(light.body + 0.35 * light.shine);
    bright = finish(light.body + mix(0.8, 1.4, solid) * light.shine);   // single hairs would shine white
    float opacity = blended(paint.a * (1.0 - 0.7 * smoothstep(0.75, 1.0, t)) * min(1.0, 0.45 + 8.0 * t) / widened);
    place = vec4(side, t, own, mix(opacity, clamp(2.5 * pixels / streaks, 0.15, 1.0), solid));
    gl_Position = view_projection * vec4(placed, 1.0);
    vec4 nearer = view_projection * vec4(placed + view * lift.x * max(stroke.z - lift.y, 0.0), 1.0);
    gl_Position.z = nearer.z / nearer.w * gl_Position.w;
}
