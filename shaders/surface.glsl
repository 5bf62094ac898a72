// The skin of this frame: positions (w: wrinkle height) in the upper half of the rows, normals in the lower half.
uniform sampler2D skin_fields;

const int SKIN_COLUMNS = 256;

vec3 skin_position(int vertex) {
    return texelFetch(skin_fields, ivec2(vertex % SKIN_COLUMNS, vertex / SKIN_COLUMNS), 0).xyz;
}

vec3 skin_normal(int vertex) {
    int row = textureSize(skin_fields, 0).y / 2 + vertex / SKIN_COLUMNS;
    return texelFetch(skin_fields, ivec2(vertex % SKIN_COLUMNS, row), 0).xyz;
}

// The middle of an edge on the cubic through both ends (PN triangles); an end itself where both are the same.
vec3 edge_position(ivec2 ends) {
    vec3 a = skin_position(ends.x), b = skin_position(ends.y), along = b - a;
    vec3 na = skin_normal(ends.x), nb = skin_normal(ends.y);
    return 0.5 * (a + b) - 0.125 * (dot(along, na) * na - dot(along, nb) * nb);
}

vec3 edge_normal(ivec2 ends) {
    return normalize(skin_normal(ends.x) + skin_normal(ends.y));
}
