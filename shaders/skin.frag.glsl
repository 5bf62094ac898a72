#version 330 core
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "shadow.glsl"
#include "wrinkles.glsl"
centroid in vec3 position, normal, blurred_normal, rest_position;
centroid in vec4 matter, tint;
centroid in float open_sky, rest_key;
centroid in vec2 atlas;
out vec4 colour;

uniform vec3 skin_tone;
uniform vec3 lip_tint;
uniform vec3 hair_colour;
uniform float shine;
uniform float mouth_front;  // z of the lips at rest
uniform float mouth_light;  // how much light the lips let in

const float CREASE_SHADE = 0.5;  // of the surroundings' light that the bottom of a crease misses

void main() {
    vec3 view = normalize(eye_point.xyz - position);
    vec3 n = normalize(normal), soft = normalize(blurred_normal);
    float crease = 0.0;
    if (wrinkled) {
        vec4 raised = wrinkled_normal(n, position, atlas);
        soft = normalize(soft + 0.5 * (raised.xyz - n));
        n = raised.xyz;
        crease = raised.w;
    }
    float lip = smoothstep(0.30, 0.75, matter.x), mouth = smoothstep(0.35, 0.9, matter.y), wet = smoothstep(0.2, 0.95, matter.z);
    vec4 coarse = noise(rest_position * 9.0), fine = noise(rest_position * 37.0);
    float mottle = coarse.r - 0.5, grain = fine.g - 0.5;

    vec3 albedo = skin_tone * (1.0 + 0.16 * mottle + 0.10 * grain);
    albedo *= mix(vec3(1.0), vec3(1.04, 0.94, 0.92), clamp(0.5 + 2.0 * (coarse.g - 0.5), 0.0, 1.0));
    albedo *= mix(vec3(1.0), vec3(1.03, 0.76, 0.74), tint.x * (0.8 + 0.8 * (coarse.g - 0.25)));
    albedo *= mix(vec3(1.0), vec3(0.90, 0.80, 0.80), tint.y);
    vec3 lips = mix(skin_tone * vec3(0.82, 0.50, 0.54), lip_tint, 0.35) * (1.0 + 0.5 * grain);
    albedo = mix(albedo, lips, 0.86 * lip);
    albedo = mix(albedo, vec3(0.34, 0.09, 0.08), mouth);
    albedo = mix(albedo, mix(skin_tone, vec3(0.45, 0.15, 0.13), 0.5) * vec3(0.95, 0.72, 0.70), 0.75 * wet);
    albedo = mix(albedo, hair_colour, tint.w * (0.75 + 0.25 * fine.r));

    float sky_light = max(open_sky, max(mix(0.40, 0.80, mouth_light) * lip, 0.32 * mouth));
    sky_light *= mix(1.0, 0.25 + 0.55 * smoothstep(-0.05, -0.005, rest_position.z - mouth_front), mouth);
    sky_light *= 1.0 - CREASE_SHADE * crease;
    vec3 occlusion = pow(vec3(sky_light), vec3(0.72, 0.95, 1.05));
    vec3 wrap = vec3(0.36, 0.20, 0.14) * (1.0 - 0.6 * mouth);
    vec3 bump = normalize(n + 0.10 * (1.0 - wet) * (1.0 - mouth) * (fine.bar - 0.5));
    float lit = mix(1.0, shadow_taps == 0 ? rest_key : key_light(position, n), smoothstep(-0.05, 0.30, dot(soft, light_direction[0].xyz)) * (1.0 - mouth));
    vec3 bled = pow(vec3(lit), vec3(0.70, 0.95, 1.05));
    vec3 diffuse = hemisphere(soft) * occlusion, gloss = vec3(0.0);
    float n_v = max(dot(bump, view), 0.02);
    float rough = mix(mix(mix(0.56, 0.44, tint.z), 0.34, lip), 0.24, max(mouth, wet));
    float f0 = mix(0.026, 0.036, max(lip, wet));
    for (int i = 0; i < LIGHTS; i++) {
        vec3 l = light_direction[i].xyz, h = normalize(l + view);
        vec3 cosines = vec3(dot(mix(bump, soft, 0.75), l), dot(mix(bump, soft, 0.35), l), dot(mix(bump, soft, 0.2), l));
        diffuse += light_colour[i].rgb * (i == 0 ? bled : vec3(1.0)) * wrapped(cosines, i < 2 ? wrap : vec3(0.1)) * mix(vec3(1.0), occlusion, i == 0 ? 0.75 : 1.0);
        float n_l = max(dot(bump, l), 0.0), n_h = max(dot(bump, h), 0.0), v_h = max(dot(view, h), 0.0);
        float lobes = (0.75 * ggx(n_h, rough) + 0.25 * ggx(n_h, 0.6 * rough)) * visibility(n_l, n_v, 0.9 * rough);
        gloss += light_colour[i].rgb * (i == 0 ? lit : 1.0) * lobes * fresnel(f0, v_h) * n_l * PI;
    }
    gloss += hemisphere(reflect(-view, bump)) * fresnel(f0, n_v) * 0.5;
    float shown = clamp(1.2 * max(open_sky, 0.2 * mouth) - 0.15, 0.0, 1.0) * (1.0 - 0.7 * mouth) * (1.0 - 0.8 * tint.w) * mix(shine, 1.0, max(lip, wet));
    colour = vec4(albedo * diffuse + gloss * shown * (0.8 + 0.8 * grain), 1.0);
}
