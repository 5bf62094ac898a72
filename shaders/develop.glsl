// From linear light to the picture: exposure, film curve, sRGB.
uniform float exposure;

// The opacity of something dark over something light, blended in the picture instead of in linear light.
float blended(float opacity) {
    return 1.0 - pow(1.0 - min(opacity, 1.0), 0.6);
}

// Narkowicz 2015, "ACES filmic tone mapping curve", x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), encoded as sRGB: both
// in one quotient of the root, to within 0.8 of 255 up to x = 12.
vec3 finish(vec3 light) {
    vec3 x = exposure * light, root = sqrt(max(x, 0.0));
    return clamp((0.98824 * x - 0.0041 * root - 0.00086) / (x - 0.09433 * root + 0.17606), 0.0, 1.0);
}
