#version 330 core
// Skin lit by vertex.
#include "frame.glsl"
#include "surface.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "mouth.glsl"
#include "complexion.glsl"
#include "atlas.glsl"
#include "develop.glsl"
#include "skin_place.glsl"
in float lit_at_rest;  // how much of the key light arrives at rest

out vec3 body;   // the picture of smooth skin; light, where the skin wears a picture
out vec2 atlas;
#ifdef TEXTURED
#include "worn.glsl"
#endif

void main() {
    vec3 own_place = edge_position(ends);
    vec4 placed = head * vec4(own_place, 1.0);
    vec3 at_normal = edge_normal(ends), n = mat3(head) * at_normal;
    vec3 soft = normalize(mat3(head) * (soft_normal + 0.6 * (at_normal - rest_normal)));
    vec3 position = placed.xyz;
    gl_Position = skin_clip(position);
    atlas = atlas_place(rest);
    vec4 coarse = textureLod(noise_volume, rest * 9.0, 0.0);
    float lip = lip_share(material.x, coarse.r - 0.5), mouth = smoothstep(0.35, 0.9, material.y), wet = smoothstep(0.2, 0.95, material.z);
    float moist = max(mouth, wet), outer = lip_outer(lip, material.y), sky = sky_light(ambient, outer, mouth, wet, own_place);
    vec3 albedo = complexion_colour(complexion, mouth, wet, coarse.g) * (0.905 + 0.19 * coarse.r + lip_ridge(material.x));
    albedo = mix(albedo, lip_colour(ambient, complexion.y), 0.86 * lip * (1.0 - mouth));

    vec3 occlusion = bled(sky, BOUNCED), wrap = WRAP * (1.0 - 0.6 * mouth), view = normalize(eye_point.xyz - position);
    float lit = mix(1.0, lit_at_rest, smoothstep(-0.05, 0.30, dot(soft, light_direction[0].xyz)));
    lit = mix(lit, 0.5 * sky, mouth);   // inside, no more than of the sky
    vec3 diffuse = hemisphere(soft) * occlusion + mouth * mouth_round(wall_fade(own_place)) * light_colour[0].rgb + lip_glow(outer * (1.0 - mouth), ambient, lit * clamp(2.0 * dot(soft, light_direction[0].xyz), 0.0, 1.0)), gloss = vec3(0.0);
    float wide = sky_wide(lip, moist);
    vec3 even = normalize(mix(n, soft, wide));
    float n_v = max(dot(even, view), 0.02), rough = roughness(complexion.z, lip, moist), f0 = mix(F0.x, F0.y, max(lip, wet));
    for (int i = 0; i < LIGHTS; i++) {
        float reach = unhidden(soft, light_direction[i].xyz, i == 1 ? FILL_OPEN : RIM_OPEN);
        vec3 l = light_direction[i].xyz, cosines = wrapped(scattered(n, soft, l), i < 2 ? wrap : RIM_WRAP);
        diffuse += light_colour[i].rgb * cosines * (i == 0 ? bled(lit, BLED) * mix(vec3(1.0), occlusion, 0.75) : reach * occlusion);
        gloss += light_colour[i].rgb * ((i == 0 ? lit : reach * (i == 1 ? 1.0 : RIM_GLOSS * (1.0 - CHEEK_HIDES * lip))) * glint(i == 0 ? n : even, l, view, n_v, i < 2 ? 0.9 * rough : mix(0.9 * rough, 1.0, wide), f0));
    }
    gloss += hemisphere(reflect(-view, even)) * fresnel(f0, n_v) * 0.5 * (1.0 - ROUGH_DULLS * wide);
    float shown = sheen(ambient, mouth, complexion.w, max(0.5 * lip, wet));
    gloss *= 0.8 * shown;
#ifdef TEXTURED
    body = wear(albedo, gloss, moist) * diffuse;
#else
    body = finish(albedo * diffuse + gloss);
#endif
}
