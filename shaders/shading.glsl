// Light on surfaces.
const float PI = 3.14159265;

// GGX, Trowbridge and Reitz 1975.
float ggx(float n_h, float roughness) {
    float a = roughness * roughness, a2 = a * a, d = n_h * n_h * (a2 - 1.0) + 1.0;
    return a2 / (PI * d * d);
}

// Smith's masking with Schlick's approximation, divided by 4 (n.l)(n.v).
float visibility(float n_l, float n_v, float roughness) {
    float k = (roughness + 1.0) * (roughness + 1.0) / 8.0;
    return 0.25 / ((n_l * (1.0 - k) + k) * (n_v * (1.0 - k) + k));
}

float fresnel(float f0, float cosine) {
    float m = 1.0 - cosine, m2 = m * m;
    return f0 + (1.0 - f0) * m2 * m2 * m;
}

vec3 hemisphere(vec3 n) {
    return mix(ground.rgb, sky.rgb, 0.5 * n.y + 0.5);
}

// Diffuse light that wraps round the terminator, by channel.
vec3 wrapped(vec3 cosines, vec3 wrap) {
    return clamp((cosines + wrap) / (1.0 + wrap), 0.0, 1.0);
}
