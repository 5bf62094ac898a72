#version 330 core
// Spreads the skin's colours over its texture coordinates, the picture's top row first; the outermost layer stays.
#include "frame.glsl"
#include "shading.glsl"
#include "complexion.glsl"
in vec3 rest;
in vec2 uv;
in vec4 material;    // lip, inside of the mouth, wet lid margin, ear
in vec4 complexion;  // redness, darker (sockets, upper lip), gloss, under the hair
uniform vec3 unwrap_centre;  // metres

out vec3 colour_here;  // without the lips
out float lip_here, upper_here;

const float FARTHEST = 0.5;  // metres

void main() {
    colour_here = complexion_colour(complexion, 0.0, smoothstep(0.2, 0.95, material.z), 0.5);
    lip_here = material.x;
    upper_here = complexion.y;
    gl_Position = vec4(2.0 * uv - 1.0, 1.0 - 2.0 * length(rest - unwrap_centre) / FARTHEST, 1.0);
}
