#version 330 core
#include "frame.glsl"
#include "shading.glsl"
#include "complexion.glsl"
in vec3 colour_here;
in float lip_here;
out vec4 colour;

// IEC 61966-2-1
vec3 to_srgb(vec3 c) {
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
    vec3 albedo = mix(colour_here, lip_colour(), 0.86 * smoothstep(0.30, 0.75, lip_here));
    colour = vec4(to_srgb(clamp(albedo, 0.0, 1.0)), 1.0);
}
