#version 330 core
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "shadow.glsl"
#include "complexion.glsl"
#include "develop.glsl"
#ifdef WRINKLED
#include "wrinkles.glsl"
centroid in vec2 atlas;
#endif
centroid in vec3 position, normal, blurred_normal, rest_position;
centroid in vec3 colour_here, around, shine_around;
centroid in vec4 matter;
centroid in vec3 light_here;
out vec4 colour;

void main() {
    vec3 view = normalize(eye_point.xyz - position);
    vec3 n = normalize(normal), soft = normalize(blurred_normal), near = around;
    float sky = light_here.x;
#ifdef WRINKLED
    vec4 raised = wrinkled_normal(n, position, atlas);
    near *= wrinkle_shade(n, raised, light_direction[1].xyz);
    soft = normalize(soft + 0.5 * (raised.xyz - n));
    n = raised.xyz;
    sky *= 1.0 - CREASE_SHADE * raised.w;
#endif
    float lip = smoothstep(0.30, 0.75, matter.x), mouth = smoothstep(0.35, 0.9, matter.y), wet = smoothstep(0.2, 0.95, matter.z);
    float moist = max(mouth, wet);
    vec4 coarse = noise(rest_position * 9.0), fine = noise(rest_position * 37.0);
    float mottle = coarse.r - 0.5, grain = fine.g - 0.5;
    vec3 albedo = mix(colour_here * (1.0 + 0.16 * mottle), lip_colour(), 0.86 * lip * (1.0 - mouth)) * (1.0 + mix(0.10, 0.5, lip) * grain);

    vec3 occlusion = bled(sky), wrap = WRAP * (1.0 - 0.6 * mouth);
    vec3 bump = normalize(n + 0.10 * (1.0 - moist) * (fine.bar - 0.5));
    vec3 key = light_direction[0].xyz;
    float lit = mix(1.0, key_light(position, n), smoothstep(-0.05, 0.30, dot(soft, key)) * (1.0 - mouth));
    vec3 diffuse = near + light_colour[0].rgb * bled(lit) * wrapped(scattered(bump, soft, key), wrap) * mix(vec3(1.0), occlusion, 0.75);

    float n_v = max(dot(bump, view), 0.02), rough = roughness(matter.w, lip, moist), f0 = mix(0.026, 0.036, max(lip, wet));
    vec3 gloss = shine_around + light_colour[0].rgb * lit * mix(glint(bump, key, view, n_v, rough, f0), glint(bump, key, view, n_v, 0.6 * rough, f0), 0.25);
    colour = vec4(finish(albedo * diffuse + gloss * light_here.y * (0.8 + 0.8 * grain)), 1.0);
}
