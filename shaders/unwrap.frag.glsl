#version 330 core
#include "frame.glsl"
#include "shading.glsl"
#include "complexion.glsl"
#include "srgb.glsl"
in vec3 colour_here;
in float lip_here, upper_here;
out vec4 colour;

void main() {
    vec3 albedo = mix(colour_here, lip_colour(1.0, upper_here), 0.86 * lip_share(lip_here, 0.0));
    colour = vec4(to_srgb(clamp(albedo, 0.0, 1.0)), 1.0);
}
