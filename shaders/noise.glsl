// Tiling noise, 0..1: r and g are independent fractals, b and a single octaves.
uniform sampler3D noise_volume;

vec4 noise(vec3 p) {
    return texture(noise_volume, p);
}
