#version 330 core
// What is behind the face.
#include "develop.glsl"
#include "noise.glsl"
in vec2 place;
out vec4 pixel;

uniform float aspect;
uniform vec3 background_inner;
uniform vec3 background_outer;

const vec2 POOL = vec2(-0.08, 0.06);   // the middle of the light on the canvas, of the picture's height from its middle
const float REACH = 0.62, UNEVEN = 1.0, SLOPE = 0.14, FLOOR = 0.72;   // how far it goes, how patchy it is, to the key light's side, what is left at the foot
const float CORNER = 0.76;   // of the picture's sides from its middle, where the lens lets nothing of it through
const float GRAIN = 0.9 / 255.0;       // against bands

// Interleaved gradient noise, Jimenez 2014.
float dither(vec2 at) {
    return fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715))));
}

void main() {
    vec2 at = (place - 0.5) * vec2(aspect, 1.0), off = (at - POOL) * vec2(0.86, 1.0);
    vec4 painted = noise(vec3(0.21 * at + 0.37, 0.2)), coarse = noise(vec3(0.62 * at, 0.7));
    float uneven = 0.65 * (painted.r - 0.5) + 0.35 * (coarse.g - 0.5);   // brushed canvas is never even
    float lit = exp(-dot(off, off) / (REACH * REACH)) * (1.0 + UNEVEN * uneven) - SLOPE * dot(at, vec2(0.8, -0.4));
    lit *= mix(FLOOR, 1.0, smoothstep(-0.62, -0.10, at.y)) * smoothstep(CORNER, 0.40, length(place - 0.5));
    vec3 behind = mix(background_outer, background_inner, clamp(lit, 0.0, 1.3));
    float grain = dither(gl_FragCoord.xy) + dither(gl_FragCoord.yx + 37.0) - 1.0;
    pixel = vec4(finish(behind) + GRAIN * grain, 1.0);
}
