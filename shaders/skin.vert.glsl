#version 330 core
// Skin lit by pixel; what changes slowly is found here.
#include "frame.glsl"
#include "surface.glsl"
#include "shading.glsl"
#include "complexion.glsl"
#include "atlas.glsl"
#include "skin_place.glsl"

centroid out vec3 position, normal, blurred_normal, rest_position;
centroid out vec3 colour_here, around;  // albedo without lips; light from everywhere but key and fill
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
    for (int i = 2; i < LIGHTS; i++)
        around += light_colour[i].rgb * wrapped(scattered(normal, soft, light_direction[i].xyz), RIM_WRAP);
    around *= bled(sky);
}
