#version 330 core
// Skin lit by vertex; wrinkles and grain by pixel.
#include "relief.glsl"
uniform sampler2D wrinkle_atlas;
in vec3 body;
in vec2 atlas;
out vec4 colour;
#ifdef TEXTURED
#include "develop.glsl"
#include "paint.glsl"
#endif

const vec3 WARM = vec3(0.75, 1.0, 1.1);  // red light gets round a wrinkle through the skin

void main() {
    float change = relief(texture(wrinkle_atlas, atlas)).a;
#ifdef TEXTURED
    vec3 smooth_skin = finish(painted(body));
#else
    vec3 smooth_skin = body;
#endif
    colour = vec4(smooth_skin + smooth_skin * change * WARM, 1.0);
}
