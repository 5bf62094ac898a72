#version 330 core
#include "frame.glsl"
#include "shading.glsl"
#include "hair.glsl"
in vec3 position, along, normal;
in vec4 tone;
out vec4 colour;

uniform float gloss;

void main() {
    vec3 view = normalize(eye_point.xyz - position);
    colour = vec4(hair_light(tone.rgb, normalize(along), normalize(normal), view, gloss, 0.0, 1.0), tone.a);
}
