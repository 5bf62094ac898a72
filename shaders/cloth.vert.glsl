#version 330 core
// Cloth lit by vertex.
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
in vec3 place;
in vec3 facing;
in vec2 detail;        // turn, metres from the collar
uniform mat4 moved;    // from rest into the scene
uniform vec3 cloth;

out vec3 body, rest_position;
out vec2 within;

void main() {
    vec4 placed = moved * vec4(place, 1.0);
    vec3 view = normalize(eye_point.xyz - placed.xyz), n = normalize(mat3(moved) * facing);
    n = dot(n, view) < 0.0 ? -n : n;
    vec3 folds = textureLod(noise_volume, place * vec3(3.1, 1.7, 3.1), 0.0).rgb;
    n = normalize(n + 0.30 * (folds - 0.5) * smoothstep(0.01, 0.06, detail.y));
    vec3 light = hemisphere(n);
    for (int i = 0; i < LIGHTS; i++) light += light_colour[i].rgb * wrapped(vec3(dot(n, light_direction[i].xyz)), vec3(0.12));
    float fuzz = pow(1.0 - clamp(dot(n, view), 0.0, 1.0), 3.0);
    body = cloth * light * (1.0 + 1.2 * fuzz) * smoothstep(-0.010, 0.006, detail.y);
    rest_position = place;
    within = detail;
    gl_Position = view_projection * placed;
}
