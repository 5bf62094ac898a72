// From linear light to the picture: exposure, film curve, sRGB.
uniform float exposure;

// Narkowicz 2015, "ACES filmic tone mapping curve".
vec3 film(vec3 x) {
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

vec3 srgb(vec3 x) {
    return mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
}

// The opacity of something dark over something light, blended in the picture instead of in linear light.
float blended(float opacity) {
    return 1.0 - pow(1.0 - min(opacity, 1.0), 0.6);
}

vec3 finish(vec3 light) {
    return srgb(film(exposure * light));
}
