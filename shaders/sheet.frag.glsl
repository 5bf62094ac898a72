#version 330 core
centroid in vec3 dull, bright;
centroid in vec4 strand;   // across in locks, along 0..1, light, a number of its own
centroid in vec3 drift;    // how hairs wander, gaps deepen and light changes
out vec4 colour;           // its opacity becomes coverage of the samples

uniform float least_cover; // of a pixel, that is drawn

const float HAIRS = 26.0;      // that are seen in a lock
const float WISP = 5.0;        // hairs that end together in a point
const float TIP = 0.09;        // of the length, over which hairs end
const float EDGE = 6.0;        // hairs a lock's width, over which the sheet's front edge grows dense
const float APART = 0.70;      // from here on locks narrow towards their tips

float scattered(float number) {
    return fract(0.618034 * number + 0.37 * floor(strand.w) + 0.11 * fract(0.1415 * number * number));
}

void main() {
    float along = strand.y, number = floor(strand.x), lock = 2.0 * (strand.x - number) - 1.0, own = scattered(3.0 * number + 1.0);
    float hairs = HAIRS * strand.x + 1.5 * drift.r, low = floor(hairs);
    float here = scattered(low), between = mix(here, scattered(low + 1.0), smoothstep(0.0, 1.0, hairs - low));
    float narrow = 1.05 - (0.15 + 0.45 * own) * smoothstep(APART, 1.0, along);
    float edge = EDGE * strand.x * (1.2 - along) + 0.8 * along;   // fewer hairs frame the face
    float wisp = hairs / WISP, ends = scattered(floor(wisp) + 7.0), last = 1.0 - TIP * ((0.3 + own) * ends * ends + 0.3 * own);
    vec3 within = vec3(edge + 0.25 - here, (last - along) / (0.6 * TIP) - abs(2.0 * fract(wisp) - 1.0), narrow + 0.35 * here - abs(lock));
    vec3 covered = clamp(0.5 + within / max(fwidth(within), 1e-4), 0.0, 1.0);
    float cover = min(covered.x, min(covered.y, covered.z));
    if (cover < least_cover) discard;
    float fine = abs(2.0 * fract(2.7 * hairs) - 1.0), gap = 1.0 - (0.06 + 0.16 * own) * smoothstep(0.5, 1.0, abs(lock)) * (0.9 + drift.g);
    float light = (1.0 + 0.16 * (between - 0.5) + 0.10 * (fine - 0.5) + 0.22 * drift.b) * gap;
    colour = vec4(mix(dull, bright, (0.25 + 0.5 * between) * gap) * light, least_cover < 0.5 ? cover : 1.0);   // with one sample a pixel there is hair or none
}
