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

centroid out vec4 tone;
centroid out vec3 place;   // across -1..1, along 0..1, a number of its own

uniform vec3 hair_centre;  // of the head, in the model's axes
uniform float narrowest;   // pixels; a thinner strand fades instead
uniform float gloss;

void main() {
    vec3 rest = skin_position(anchor) + offset;
    vec3 placed = (head * vec4(rest, 1.0)).xyz, along = mat3(head) * along_rest;
    vec3 outward = rest - hair_centre;
    outward.y = max(outward.y, -0.25 * length(outward.xz));
    vec3 n = mat3(head) * normalize(outward);
    vec3 towards = eye_point.xyz - placed, view = normalize(towards);
    float own = fract(paint.r * 3571.0 + float(anchor) * 0.618);

    float t = stroke.x, pixels = stroke.y * eye_point.w / length(towards);
    float taper = (1.0 - smoothstep(0.62, 1.02, t)) * mix(0.8, 1.0, smoothstep(0.0, 0.12, t));
    float widened = max(1.0, narrowest / max(pixels * taper, 1e-4));
    // the head hides its far side, though not what hangs below it
    float seen = dot(n, view) < -0.3 && rest.y > hair_centre.y - 0.03 ? 0.0 : 1.0;
    placed += normalize(cross(along, towards)) * side * seen * stroke.y * taper * widened;

    vec3 base = paint.rgb * mix(1.0, 1.25, smoothstep(0.5, 1.0, t));
    vec3 light = hair_light(base, along, n, view, gloss, 0.22 * (own - 0.5), stroke.z);
    tone = vec4(finish(light), blended(paint.a * (1.0 - 0.7 * smoothstep(0.75, 1.0, t)) * min(1.0, 0.45 + 8.0 * t) / widened));
    place = vec3(side, t, own);
    gl_Position = view_projection * vec4(placed, 1.0);
}
