#version 330 core
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "complexion.glsl"
#include "develop.glsl"
#ifdef WRINKLED
#include "wrinkles.glsl"
centroid in vec2 atlas;
#endif
#ifdef TEXTURED
#include "paint.glsl"
#endif
centroid in vec3 normal, rest_position, towards, around, key_body;
centroid in vec4 matter;
centroid in float soft_key;
out vec4 colour;

void main() {
    vec3 view = normalize(towards), n = normalize(normal), key = light_direction[0].xyz, light = around, body = key_body;
    float lip = matter.x, moist = matter.y, rough = matter.z, soft = soft_key;
#ifdef WRINKLED
    vec4 raised = wrinkled_normal(n, rest_position, atlas);
    light *= wrinkle_shade(n, raised, light_direction[1].xyz);
    soft += 0.5 * dot(raised.xyz - n, key);
    body *= 1.0 - 0.8 * CREASE_SHADE * raised.w;
    n = raised.xyz;
#endif
    vec4 fine = noise(rest_position * 83.0);
    float grain = fine.g - 0.5;
    vec3 bump = normalize(n + (1.0 - moist) * mix(0.15, 0.30, lip) * (fine.bar - 0.5)), h = normalize(key + view);
    float facing = dot(bump, key), n_l = max(facing, 0.0), n_v = max(dot(bump, view), 0.02), n_h = max(dot(bump, h), 0.0);
    vec3 wrap = WRAP * (1.0 - 0.6 * moist);
    light += body * wrapped(mix(vec3(facing), vec3(soft), SCATTERED), wrap);
#ifdef TEXTURED
    light = painted(light);
#endif

    float lobes = mix(ggx(n_h, rough), ggx(n_h, 0.7 * rough), 0.2) * visibility(n_l, n_v, 0.8 * rough);
    float gloss = PI * n_l * lobes * fresnel(mix(F0.x, F0.y, max(lip, moist)), max(dot(view, h), 0.0));
    colour = vec4(finish(light * (1.0 + mix(0.16, 0.45, lip) * grain) + light_colour[0].rgb * (gloss * matter.w * (0.85 + 0.8 * (fine.b - 0.5)))), 1.0);
}
