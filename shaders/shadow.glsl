// How much of the key light arrives, from its picture of depths.
uniform sampler2DShadow key_depth;

// A tent over 3 x 3 texels in four looks (Castano 2013, "Shadow mapping summary").
float key_light(vec3 at, vec3 n) {
    vec3 q = 0.5 * (shadow_projection * vec4(at + 0.0035 * n, 1.0)).xyz + 0.5;
    float texels = float(textureSize(key_depth, 0).x), texel = 1.0 / texels;
    vec2 base = floor(q.xy * texels + 0.5), part = q.xy * texels + 0.5 - base;
    vec2 low = 3.0 - 2.0 * part, high = 1.0 + 2.0 * part;
    vec2 below = (base + (2.0 - part) / low - 1.5) * texel, above = (base + part / high + 0.5) * texel;
    float z = q.z - 0.0050;
    float lit = low.x * low.y * texture(key_depth, vec3(below, z)) + high.x * low.y * texture(key_depth, vec3(above.x, below.y, z))
        + low.x * high.y * texture(key_depth, vec3(below.x, above.y, z)) + high.x * high.y * texture(key_depth, vec3(above, z));
    return lit / 16.0;
}
