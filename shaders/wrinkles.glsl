// Wrinkles finer than the mesh; the atlas is written by agentface/view/skin/wrinkle_atlas.py.
#include "atlas.glsl"
#include "relief.glsl"
// signed roots of the slopes to the face's left and up, how near a crease is, what that makes of the picture at rest
uniform sampler2D wrinkle_atlas;

const float STEEPEST = 2.0;       // the slope whose root is 1
const float CREASE_SHADE = 0.85;   // of the light that the bottom of a crease misses
const vec3 CREASED = CREASE_SHADE * vec3(0.85, 1.03, 1.10);   // red comes through the skin

// What wrinkles make of light from l on skin with the normal n.
vec3 wrinkle_shade(vec3 n, vec4 raised, vec3 l) {
    vec2 facing = max(vec2(dot(raised.xyz, l), dot(n, l)), -0.2) + 0.8;
    return facing.x / facing.y * (1.0 - CREASED * raised.w);
}

// The normal of the skin with its wrinkles: Mikkelsen's surface gradient (2010). w: the crease.
vec4 wrinkled_normal(vec3 n, vec3 rest, vec2 at) {
    vec3 texel = relief(texture(wrinkle_atlas, at)).rgb;
    vec2 slope = STEEPEST * texel.rg * abs(texel.rg);
    vec3 rise = mat3(head) * vec3(slope.x * normalize(vec2(rest.z, -rest.x)), slope.y).xzy;
    return vec4(normalize(n - rise + n * dot(n, rise)), texel.b);
}
