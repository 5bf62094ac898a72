#version 330 core
#include "frame.glsl"
#include "shading.glsl"
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

uniform sampler3D pores;   // slopes of the skin's microrelief, its height

const float FINENESS = 131.0;                // volumes a metre
const vec3 LINED = vec3(1.4, 0.37, 0.74);     // lips have lines that run up and down
const float THROUGH = 0.4;   // how much of the relief the light in the skin shows
const float SPARSENESS = 43.0, SPOT_FROM = 0.60, SPOT_TO = 0.12;   // volumes a metre, heights: where the deepest pits are, skin is darker
const vec3 SPOT = vec3(0.92, 0.84, 0.81);
const float RELIEF = 0.25, LIP_RELIEF = 0.32, PLATEAU = 0.92;
const mat3 ASLANT = mat3(0.64, -0.60, 0.48, 0.48, 0.80, 0.36, -0.60, 0.0, 0.80);   // so that no row of the volume's pits lies along the face

void main() {
    vec3 view = normalize(towards), n = normalize(normal), key = light_direction[0].xyz, light = around, body = key_body;
    float lip = matter.x, moist = matter.y, rough = matter.z, soft = soft_key;
#ifdef WRINKLED
    vec4 raised = wrinkled_normal(n, rest_position, atlas);
    light *= wrinkle_shade(n, raised, light_direction[1].xyz);
    soft += 0.5 * dot(raised.xyz - n, key);
    body *= 1.0 - 0.8 * CREASED * raised.w;
    n = raised.xyz;
#endif
    vec4 fine = texture(pores, ASLANT * (rest_position * FINENESS * mix(vec3(1.0), LINED, lip)));
    vec3 slope = mat3(head) * ((2.0 * fine.xyz - 1.0) * ASLANT);
    float seen = clamp(0.0018 * eye_point.w * inversesqrt(dot(towards, towards)) - 0.9, 0.3, 1.2);   // relief below a pixel would flicker
    vec3 bump = normalize(n - (1.0 - moist) * seen * mix(RELIEF, LIP_RELIEF, lip) * (slope - n * dot(slope, n))), h = normalize(key + view);
    float facing = dot(mix(n, bump, THROUGH), key), n_l = max(dot(bump, key), 0.0), n_v = max(dot(bump, view), 0.02), n_h = max(dot(bump, h), 0.0);
    vec3 wrap = WRAP * (1.0 - 0.6 * moist);
    light += body * wrapped(mix(vec3(facing), vec3(soft), SCATTERED), wrap);
#ifdef TEXTURED
    light = painted(light);
#endif

    float lobes = mix(ggx(n_h, rough), ggx(n_h, 0.6 * rough), 0.25 - 0.10 * lip) * visibility(n_l, n_v, 0.8 * rough);
    float gloss = PI * n_l * lobes * fresnel(mix(F0.x, F0.y, max(lip, moist)), max(dot(view, h), 0.0));
    float pit = fine.w - PLATEAU, spot = smoothstep(SPOT_FROM, SPOT_TO, texture(pores, rest_position * SPARSENESS).w) * (1.0 - max(lip, moist));
    light *= mix(vec3(1.0), SPOT, spot);
    colour = vec4(finish(light * (1.0 + mix(0.14, 0.36, lip) * pit) + light_colour[0].rgb * (gloss * matter.w * (1.0 + 0.9 * pit))), 1.0);
}
