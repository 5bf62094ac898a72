#version 330 core
// Teeth, gums and tongue inside the mouth, and cloth outside of it.
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
centroid in vec3 position, normal, rest_position;
centroid in vec4 matter;
out vec4 colour;

uniform float mouth_front;  // z of the lips at rest
uniform float mouth_light;  // how much light the lips let in
uniform vec3 cloth;

void main() {
    vec3 view = normalize(eye_point.xyz - position), n = normalize(normal);
    n = dot(n, view) < 0.0 ? -n : n;
    float inside = clamp(matter.x + matter.y + matter.z, 0.0, 1.0);
    vec4 fine = noise(rest_position * 60.0);
    vec3 albedo = matter.x * vec3(0.68, 0.60, 0.48) + matter.y * vec3(0.46, 0.16, 0.15) + matter.z * vec3(0.46, 0.15, 0.14);
    albedo = (albedo + matter.w * cloth) * (0.9 + 0.2 * fine.r);
    float rough = mix(0.8, mix(0.40, 0.26, matter.x), inside), f0 = mix(0.02, 0.04, inside);
    float depth = mix(1.0, smoothstep(-0.050, 0.004, rest_position.z - mouth_front), inside);
    float reach = mix(1.0, mix(0.10, 0.85, depth) * mouth_light, inside);
    vec3 light = hemisphere(n), gloss = vec3(0.0);
    float n_v = max(dot(n, view), 0.02);
    for (int i = 0; i < LIGHTS; i++) {
        if (i > 1 && inside > 0.5) break;
        vec3 l = light_direction[i].xyz, h = normalize(l + view);
        float n_l = max(dot(n, l), 0.0);
        light += light_colour[i].rgb * mix(0.05, 0.75, 1.0) * wrapped(vec3(dot(n, l)), vec3(0.35 * inside + 0.05));
        gloss += light_colour[i].rgb * ggx(max(dot(n, h), 0.0), rough) * visibility(n_l, n_v, rough) * fresnel(f0, max(dot(view, h), 0.0)) * n_l * PI;
    }
    colour = vec4((albedo * light + gloss) * reach, 1.0);
}
