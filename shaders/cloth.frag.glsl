#version 330 core
// Knitted cloth with a ribbed collar.
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "develop.glsl"
centroid in vec3 position, normal, rest_position;
centroid in vec2 within;   // turn, metres from the collar
out vec4 colour;

uniform vec3 cloth;

const float RIBBED = 0.014;  // metres of the collar

void main() {
    vec3 view = normalize(eye_point.xyz - position), n = normalize(normal);
    n = dot(n, view) < 0.0 ? -n : n;
    float ribbed = smoothstep(RIBBED, RIBBED - 0.001, within.y), seam = exp(-pow((within.y - RIBBED) / 0.0008, 2.0));
    float rib = abs(2.0 * fract(44.0 * within.x) - 1.0);
    vec4 folds = noise(rest_position * vec3(3.1, 1.7, 3.1));
    n = normalize(n + 0.30 * (folds.rgb - 0.5) * smoothstep(0.01, 0.06, within.y));
    float worn = mix(0.92 + 0.16 * noise(rest_position * 90.0).b, 0.70 + 0.45 * rib, ribbed) * (1.0 - 0.45 * seam);
    vec3 light = hemisphere(n);
    for (int i = 0; i < LIGHTS; i++) light += light_colour[i].rgb * wrapped(vec3(dot(n, light_direction[i].xyz)), vec3(0.12));
    float fuzz = pow(1.0 - clamp(dot(n, view), 0.0, 1.0), 3.0);
    colour = vec4(finish(cloth * worn * light * (1.0 + 1.2 * fuzz) * smoothstep(-0.004, 0.012, within.y + 0.006)), 1.0);
}
