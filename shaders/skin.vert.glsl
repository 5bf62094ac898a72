#version 330 core
// Skin lit by pixel; what changes slowly is found here.
#include "frame.glsl"
#include "surface.glsl"
#include "shading.glsl"
#include "complexion.glsl"
#include "atlas.glsl"
#include "skin_place.glsl"

centroid out vec3 position, normal, blurred_normal, rest_position;
centroid out vec3 colour_here, around, shine_around;  // albedo without lips; light, and gloss, of all but the key
centroid out vec4 matter;               // lip, inside of the mouth, wet lid margin, gloss
centroid out vec3 light_here;           // how much of the surroundings' light arrives; shine; under the hair
#ifdef WRINKLED
centroid out vec2 atlas;
#endif

void main() {
    vec4 placed = head * vec4(edge_position(ends), 1.0);
    vec3 n = edge_normal(ends);
    position = placed.xyz;
    normal = mat3(head) * n;
    blurred_normal = mat3(head) * (soft_normal + 0.6 * (n - rest_normal));
    rest_position = rest;
    gl_Position = skin_clip(position);
#ifdef WRINKLED
    atlas = atlas_place(rest);
#endif
    float lip = smoothstep(0.30, 0.75, material.x), mouth = smoothstep(0.35, 0.9, material.y), wet = smoothstep(0.2, 0.95, material.z);
    matter = vec4(material.xyz, complexion.z);
    colour_here = complexion_colour(complexion, mouth, wet, 0.5);
    float sky = sky_light(ambient, lip, mouth, rest.z);
    light_here = vec3(sky, sheen(ambient, mouth, complexion.w, max(lip, wet)), complexion.w);
    vec3 soft = normalize(blurred_normal);
    around = hemisphere(soft);
    vec3 view = normalize(eye_point.xyz - position), wrap = WRAP * (1.0 - 0.6 * mouth);
    float n_v = max(dot(normal, view), 0.02), rough = 0.9 * roughness(complexion.z, lip, max(mouth, wet)), f0 = mix(0.026, 0.036, max(lip, wet));
    shine_around = hemisphere(reflect(-view, normal)) * fresnel(f0, n_v) * 0.5;
    for (int i = 1; i < LIGHTS; i++) {
        vec3 l = light_direction[i].xyz;
        around += light_colour[i].rgb * wrapped(scattered(normal, soft, l), i == 1 ? wrap : RIM_WRAP);
        shine_around += light_colour[i].rgb * glint(normal, l, view, n_v, rough, f0);
    }
    around *= bled(sky);
}
