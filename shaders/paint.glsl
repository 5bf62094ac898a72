// The picture that the skin wears.
uniform sampler2D skin_picture;   // straight alpha
centroid in vec3 own, gleam, worn;

// Light of white skin on the skin as it is.
vec3 painted(vec3 light) {
    vec4 picture = texture(skin_picture, worn.xy);
    return light * mix(own, picture.rgb, picture.a * worn.z) + gleam;
}
