// What the light is to meet in the picture that the skin wears, instead of at the vertex.
in vec3 picture;   // place in the picture, right and down; how much of it shows

centroid out vec3 own, gleam;   // the skin's colour without the picture; the light that it sends back before
centroid out vec4 worn;         // place in the picture, how much of it shows, how much hair hides it

// The colour for the vertex: white, for the pixel brings its own.
vec3 wear(vec3 albedo, vec3 gloss, float moist) {
    own = albedo;
    gleam = gloss;
    worn = vec4(picture.xy, picture.z * (1.0 - moist), HIDDEN * complexion.w);
    return vec3(1.0);
}
