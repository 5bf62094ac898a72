#version 330 core
// What is behind the face.
#include "develop.glsl"
in vec2 place;
out vec4 pixel;

uniform float aspect;
uniform vec3 background_inner;
uniform vec3 background_outer;

// Interleaved gradient noise, Jimenez 2014.
float dither(vec2 at) {
    return fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715))));
}

void main() {
    vec2 off = (place - vec2(0.5, 0.55)) * vec2(aspect, 1.0);
    vec3 behind = mix(background_inner, background_outer, smoothstep(0.05, 0.85, length(off)));
    pixel = vec4(finish(behind) + (dither(gl_FragCoord.xy) - 0.5) / 255.0, 1.0);
}
