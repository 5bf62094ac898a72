#version 330 core
// Bone, amber where tissue lies on it, red where it stands out of the skin.
#include "frame.glsl"
#include "shading.glsl"
#include "develop.glsl"
in vec3 position, normal;
in float warm;
out vec4 colour;

const vec3 BONE = vec3(0.60, 0.54, 0.43), AMBER = vec3(0.70, 0.30, 0.05), RED = vec3(0.62, 0.03, 0.02);

void main() {
    vec3 view = normalize(eye_point.xyz - position), n = normalize(normal);
    n = dot(n, view) < 0.0 ? -n : n;
    vec3 light = 0.8 * hemisphere(n);
    for (int i = 0; i < LIGHTS; i++) light += light_colour[i].rgb * wrapped(vec3(dot(n, light_direction[i].xyz)), vec3(0.08));
    vec3 albedo = mix(mix(BONE, AMBER, min(2.0 * warm, 1.0)), RED, smoothstep(0.75, 1.0, warm));
    colour = vec4(finish(albedo * light), 1.0);
}
