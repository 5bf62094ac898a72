#version 330 core
// Skin lit by pixel; what changes slowly is found here.
#include "frame.glsl"
#include "surface.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "shadow.glsl"
#include "mouth.glsl"
#include "complexion.glsl"
#include "atlas.glsl"
#include "skin_place.glsl"

centroid out vec3 normal, rest_position, towards;   // towards the camera, metres
centroid out vec3 around;      // the picture of all light but the key's
centroid out vec3 key_body;    // the key light that the skin sends back where it faces it
centroid out vec4 matter;      // lip, moist, roughness, how much of the key light's gloss is seen
centroid out float soft_key;   // cosine of the blurred skin to the key light
#ifdef WRINKLED
centroid out vec2 atlas;
#endif
#ifdef TEXTURED
#include "worn.glsl"
#endif

void main() {
    vec3 own_place = edge_position(ends);
    vec4 placed = head * vec4(own_place, 1.0);
    vec3 n = edge_normal(ends), position = placed.xyz, soft = normalize(mat3(head) * (soft_normal + 0.6 * (n - rest_normal)));
    n = mat3(head) * n;
    normal = n;
    rest_position = rest;
    towards = eye_point.xyz - position;
    gl_Position = skin_clip(position);
#ifdef WRINKLED
    atlas = atlas_place(rest);
#endif
    vec4 coarse = textureLod(noise_volume, rest * 9.0, 0.0);
    float mottle = coarse.r - 0.5, lip = lip_share(material.x, mottle);
    float mouth = smoothstep(0.35, 0.9, material.y), wet = smoothstep(0.2, 0.95, material.z);
    float moist = max(mouth, wet), outer = lip_outer(lip, material.y), sky = sky_light(ambient, outer, mouth, wet, own_place), shown = sheen(ambient, mouth, complexion.w, max(0.5 * lip, wet));
    vec3 albedo = complexion_colour(complexion, mouth, wet, mix(0.5, coarse.g, 0.6)) * (1.0 + 0.19 * mottle + lip_ridge(material.x));
    albedo = mix(albedo, lip_colour(ambient, complexion.y), 0.86 * lip * (1.0 - mouth));

    vec3 view = normalize(towards), wrap = WRAP * (1.0 - 0.6 * mouth), light = hemisphere(soft), occlusion = bled(sky, BOUNCED), key = light_direction[0].xyz;
    float wide = sky_wide(lip, moist);
    vec3 even = normalize(mix(n, soft, wide));
    float n_v = max(dot(even, view), 0.02), rough = roughness(complexion.z, lip, moist), f0 = mix(F0.x, F0.y, max(lip, wet));
    vec3 gloss = hemisphere(reflect(-view, even)) * fresnel(f0, n_v) * 0.5 * (1.0 - ROUGH_DULLS * wide);
    for (int i = 1; i < LIGHTS; i++) {
        vec3 l = light_direction[i].xyz;
        vec3 arrives = light_colour[i].rgb * unhidden(soft, l, i == 1 ? FILL_OPEN : RIM_OPEN);
        light += arrives * wrapped(scattered(n, soft, l), i == 1 ? wrap : RIM_WRAP);
        gloss += arrives * ((i == 1 ? 1.0 : RIM_GLOSS * (1.0 - CHEEK_HIDES * lip)) * glint(even, l, view, n_v, i == 1 ? 0.9 * rough : mix(0.9 * rough, 1.0, wide), f0));
    }
    gloss *= 0.8 * shown;
#ifdef TEXTURED
    albedo = wear(albedo, gloss, moist);
    gloss = vec3(0.0);
#endif
    soft_key = dot(soft, key);
    float lit = mix(1.0, key_light(position, n), smoothstep(-0.05, 0.30, soft_key));
    around = albedo * (light * occlusion + mouth * mouth_round(wall_fade(own_place)) * light_colour[0].rgb + lip_glow(outer * (1.0 - mouth), ambient, lit * clamp(2.0 * soft_key, 0.0, 1.0))) + gloss;
    lit = mix(lit, 0.5 * sky, mouth);   // inside, no more than of the sky
    key_body = albedo * light_colour[0].rgb * bled(lit, BLED) * mix(vec3(1.0), occlusion, 0.75);
    matter = vec4(lip, moist, rough, lit * shown * (1.0 - UPPER_DULL * lip * complexion.y));
}
