#version 330 core
// A hair: a curve from a root on a triangle of the skin, widened to a ribbon that faces the camera.
#include "frame.glsl"
#include "surface.glsl"
#include "shading.glsl"
#include "hair.glsl"
#include "develop.glsl"
in ivec3 corners;      // the triangle's vertices
in vec3 weights;       // where the root lies in it
in vec3 bend;          // the curve's middle control point from the root, in the root's axes, metres
in vec3 tip;           // its end
in vec3 stroke;        // place along the curve 0..1, side -1 or 1, radius in metres
in vec4 paint;         // colour and opacity

out vec4 tone;

uniform float gloss;

const float NARROWEST = 0.55;  // pixels; thinner hair fades instead

void main() {
    vec3 a = skin_position(corners.x), b = skin_position(corners.y);
    vec3 root = weights.x * a + weights.y * b + weights.z * skin_position(corners.z);
    vec3 n = normalize(weights.x * skin_normal(corners.x) + weights.y * skin_normal(corners.y) + weights.z * skin_normal(corners.z));
    vec3 x = normalize((b - a) - n * dot(b - a, n));
    mat3 axes = mat3(head) * mat3(x, cross(n, x), n);

    float t = stroke.x;
    vec3 placed = (head * vec4(root, 1.0)).xyz + axes * (2.0 * t * (1.0 - t) * bend + t * t * tip);
    vec3 along = normalize(axes * ((2.0 - 4.0 * t) * bend + 2.0 * t * tip));
    vec3 towards = eye_point.xyz - placed;
    float pixels = stroke.z * eye_point.w / length(towards);
    float widened = max(1.0, NARROWEST / pixels);
    float taper = (1.0 - 0.85 * pow(t, 1.6)) * min(1.0, 0.8 + 1.5 * t);
    vec3 sideways = cross(along, towards);
    placed += normalize(sideways) * stroke.y * stroke.z * widened * taper;
    vec3 light = hair_light(paint.rgb, along, axes[2], normalize(towards), gloss, 0.0, 1.0);
    tone = vec4(finish(light), blended(paint.a / widened * (1.0 - 0.75 * t * t) * min(1.0, 0.8 + 1.2 * t)));
    gl_Position = view_projection * vec4(placed, 1.0);
}
