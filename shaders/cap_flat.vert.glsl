#version 330 core
// The layer on the scalp at its texture coordinates, without light.
in vec2 uv;
in vec3 rest;
in float depth;   // behind the hairline 0..1

centroid out vec3 lit, scalp, rest_position;
centroid out float edge;

uniform vec3 lit_colour, scalp_colour;   // sRGB

void main() {
    lit = lit_colour;
    scalp = scalp_colour;
    rest_position = rest;
    edge = depth;
    gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0);
}
