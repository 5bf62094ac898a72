#version 330 core
// A picture, pixel by pixel.
out vec4 pixel;

uniform sampler2D picture;

void main() {
    pixel = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
}
