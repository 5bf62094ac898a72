#version 330 core
// From linear light to the picture: background, exposure, film curve, sRGB, dither.
in vec2 place;
out vec4 pixel;

uniform sampler2D light;
uniform float exposure;
uniform float aspect;
uniform vec3 background_inner;
uniform vec3 background_outer;
uniform bool see_through;  // straight alpha in place of a background

// Narkowicz 2015, "ACES filmic tone mapping curve".
vec3 film(vec3 x) {
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

vec3 srgb(vec3 x) {
    return mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
}

// Interleaved gradient noise, Jimenez 2014.
float dither(vec2 at) {
    return fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715))));
}

void main() {
    vec4 seen = texture(light, place);
    vec2 off = (place - vec2(0.5, 0.55)) * vec2(aspect, 1.0);
    float r = length(off);
    vec3 behind = mix(background_inner, background_outer, smoothstep(0.05, 0.85, r));
    float cover = clamp(seen.a, 0.0, 1.0);
    vec3 light_here = see_through ? seen.rgb / max(cover, 1e-4) : seen.rgb + (1.0 - cover) * behind;
    vec3 x = srgb(film(exposure * light_here)) + (dither(gl_FragCoord.xy) - 0.5) / 255.0;
    pixel = see_through ? vec4(x * step(0.5 / 255.0, cover), cover) : vec4(x, 1.0);
}
