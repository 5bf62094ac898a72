#version 330 core
// Teeth, gums and tongue.
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "develop.glsl"
centroid in vec3 position, normal, rest_position;
centroid in vec4 matter;   // tooth, gum, tongue
centroid in vec2 within;   // on a tooth: across -1..1, up 0 (edge)..1 (gum)
out vec4 colour;

uniform float mouth_front;  // z of the lips at rest
uniform float mouth_light;  // how much light the lips let in

const vec3 BOUNCED = vec3(0.20, 0.12, 0.10);  // light that the inside of the mouth sends back

vec3 enamel() {
    float up = within.y, aside = within.x * within.x;
    vec3 c = mix(vec3(0.87, 0.79, 0.68), vec3(0.80, 0.67, 0.46), smoothstep(0.35, 1.0, up));
    c = mix(c, vec3(0.66, 0.65, 0.60), 0.5 * smoothstep(0.18, 0.02, up));   // the edge lets light through
    c *= mix(1.0, 0.93, smoothstep(0.008, 0.013, abs(rest_position.x)) * smoothstep(0.020, 0.014, abs(rest_position.x)));
    c *= mix(vec3(1.0), vec3(0.60, 0.50, 0.42), smoothstep(0.75, 1.05, aside));   // between the teeth
    return c * mix(vec3(1.0), vec3(0.72, 0.50, 0.42), smoothstep(0.72, 1.0, up));  // under the gum
}

void main() {
    vec3 view = normalize(eye_point.xyz - position), n = normalize(normal);
    n = dot(n, view) < 0.0 ? -n : n;
    vec4 grain = noise(rest_position * 150.0);
    float tongue = matter.z, groove = exp(-pow(rest_position.x / 0.0016, 2.0));
    n = normalize(n + (0.05 * matter.x + 0.12 * matter.y + 0.30 * tongue) * (grain.bag - 0.5));
    vec3 albedo = matter.x * enamel() + matter.y * vec3(0.52, 0.20, 0.19) + tongue * vec3(0.54, 0.20, 0.19) * (1.0 - 0.25 * groove);
    albedo *= mix(0.88 + 0.24 * grain.r, 0.97 + 0.06 * grain.r, matter.x);
    float rough = mix(0.34, 0.20, matter.x);
    float depth = smoothstep(-0.046, 0.002, rest_position.z - mouth_front);
    float reach = mix(0.16, 1.0, depth * mix(depth, 1.0, matter.x)) * mouth_light;
    vec3 light = hemisphere(n) + BOUNCED, gloss = vec3(0.0);
    float n_v = max(dot(n, view), 0.02);
    for (int i = 0; i < 2; i++) {
        vec3 l = light_direction[i].xyz, h = normalize(l + view);
        float n_l = max(dot(n, l), 0.0);
        light += light_colour[i].rgb * wrapped(vec3(dot(n, l)), mix(vec3(0.40, 0.28, 0.22), vec3(0.42), matter.x));
        gloss += light_colour[i].rgb * ggx(max(dot(n, h), 0.0), rough) * visibility(n_l, n_v, rough) * fresnel(0.042, max(dot(view, h), 0.0)) * n_l * PI;
    }
    gloss += hemisphere(reflect(-view, n)) * fresnel(0.042, n_v) * 0.6;
    vec3 warm = mix(vec3(1.45, 0.76, 0.62), vec3(1.04, 0.96, 0.88), depth);  // light that lips and cheeks let through
    colour = vec4(finish((albedo * light * warm + gloss * depth) * reach), 1.0);
}
