#version 330 core
centroid in vec3 dull, bright;
centroid in vec4 place;
out vec4 colour;

uniform float streaks;
uniform float solid;

// Neighbouring numbers get distant ones, 0..1.
float scattered(float number) {
    return fract(0.618034 * number + 5.3 * place.z);
}

void main() {
    if (solid == 0.0) {
        float across = place.x * place.x;
        colour = vec4(mix(dull, bright, 0.6), place.w * (1.0 - across * across));
        return;
    }
    float hairs = 0.5 * streaks * place.x + 11.0 * place.z;
    float low = floor(hairs), between = smoothstep(0.0, 1.0, hairs - low);
    float here = mix(scattered(low), scattered(low + 1.0), between);
    float strength = place.w, fine = abs(2.0 * fract(2.7 * hairs) - 1.0);
    float light = 1.0 + strength * (0.34 * (here - 0.55) + 0.14 * (fine - 0.5));
    colour = vec4(mix(dull, bright, mix(0.5, here, strength)) * light, 1.0);
}
