// How much of the key light arrives, from its picture of depths.
uniform sampler2DShadow key_depth;
uniform int shadow_taps;

float key_light(vec3 at, vec3 n) {
    vec3 q = 0.5 * (shadow_projection * vec4(at + 0.0035 * n, 1.0)).xyz + 0.5;
    vec2 texel = 1.0 / vec2(textureSize(key_depth, 0));
    float lit = 0.0;
    for (int i = 0; i < shadow_taps; i++) {  // a spiral
        float turn = 2.4 * float(i), r = 4.0 * sqrt((float(i) + 0.5) / float(shadow_taps));
        lit += texture(key_depth, vec3(q.xy + r * texel * vec2(cos(turn), sin(turn)), q.z - 0.0012));
    }
    return lit / float(shadow_taps);
}
