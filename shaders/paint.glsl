// The picture that the skin wears.
uniform sampler2D skin_picture;   // straight alpha
#include "frame.glsl"
#include "shading.glsl"
#include "complexion.glsl"
centroid in vec3 own, gleam;
centroid in vec4 worn;

// Light of white skin on the skin as it is.
vec3 painted(vec3 light) {
    vec4 picture = texture(skin_picture, worn.xy);
    return light * mix(own, mix(picture.rgb, hair_colour, worn.w), picture.a * worn.z) + gleam;
}
