// Wrinkles finer than the mesh; the atlas is written by agentface/view/wrinkles.py.
#include "atlas.glsl"
uniform sampler2D wrinkle_atlas;  // metres of height; 0..1 how near a crease is

const float CREASE_SHADE = 0.5;   // of the light that the bottom of a crease misses

// What wrinkles make of light from l on skin with the normal n.
float wrinkle_shade(vec3 n, vec4 raised, vec3 l) {
    vec2 facing = max(vec2(dot(raised.xyz, l), dot(n, l)), -0.2) + 0.8;
    return facing.x / facing.y * (1.0 - CREASE_SHADE * raised.w);
}

// The normal of the skin with its wrinkles: Mikkelsen's surface gradient (2010), from differences over a pixel, or
// over a texel and a half where that is more. w: the crease.
vec4 wrinkled_normal(vec3 n, vec3 place, vec2 at) {
    vec2 right = dFdx(at), up = dFdy(at);
    float texel = 1.5 / float(textureSize(wrinkle_atlas, 0).x);
    float step_x = max(1.0, texel / max(length(right), 1e-7)), step_y = max(1.0, texel / max(length(up), 1e-7));
    vec2 here = texture(wrinkle_atlas, at).rg;
    float rise_x = (texture(wrinkle_atlas, at + step_x * right).r - here.r) / step_x;
    float rise_y = (texture(wrinkle_atlas, at + step_y * up).r - here.r) / step_y;
    vec3 along_x = dFdx(place), along_y = dFdy(place);
    vec3 a = cross(along_y, n), b = cross(n, along_x);
    float area = dot(along_x, a);
    return vec4(normalize(abs(area) * n - sign(area) * (rise_x * a + rise_y * b)), here.g);
}
