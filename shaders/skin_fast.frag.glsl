#version 330 core
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "develop.glsl"
#ifdef WRINKLED
#include "wrinkles.glsl"
centroid in vec2 atlas;
#endif
centroid in vec3 position, normal, rest_position;
centroid in vec3 body;
centroid in vec2 shiny;
out vec4 colour;

const float F0 = 0.028;

void main() {
    vec3 view = normalize(eye_point.xyz - position), n = normalize(normal), light = body;
    vec3 key = light_direction[0].xyz, h = normalize(key + view);
#ifdef WRINKLED
    vec4 raised = wrinkled_normal(n, position, atlas);
    light *= wrinkle_shade(n, raised, key);
    n = raised.xyz;
#endif
    float grain = noise(rest_position * 37.0).g - 0.5, n_l = max(dot(n, key), 0.0), n_v = max(dot(n, view), 0.02);
    float lobe = PI * n_l * ggx(max(dot(n, h), 0.0), 0.8 * shiny.y) * visibility(n_l, n_v, 0.8 * shiny.y) * fresnel(F0, max(dot(view, h), 0.0));
    colour = vec4(finish(light * (1.0 + 0.13 * grain) + light_colour[0].rgb * (lobe * shiny.x * (0.8 + 0.8 * grain))), 1.0);
}
