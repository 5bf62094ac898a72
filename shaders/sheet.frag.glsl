#version 330 core
centroid in vec3 dull, bright;
centroid in vec4 strand;   // across in locks, along 0..1, light, a number of its own
centroid in vec3 drift;    // how hairs wander, the front edge does and light changes
in vec2 spread;            // the first two of strand, whose differences from pixel to pixel hold at edges, too
out vec4 colour;           // its opacity becomes coverage of the samples

uniform float least_cover; // of a pixel, that is drawn

const float HAIRS = 64.0;      // that are seen in a lock
const float CARDS = 14.0;      // the first number of a lock that is a card
const float CARD_HAIRS = 40.0; // that are seen in a card
const float WISP = 4.0;        // hairs that keep together
const float UNEQUAL = 0.45;    // how unequal they are
const float POINTED = 0.35;     // how far they end in a point
const float TIP = 0.10;        // of the length, over which hairs end
const float ROOT = 0.010;      // of the length, over which they begin
const float BLUNT = 0.75;      // of its width, with which it does
const float SHEET_ROOT = 0.2; // of that, for the sheets, through which one would see past the head
const float EDGE = 3.0;        // hairs a lock's width, over which the sheet's front edge grows dense
const float GAP = 0.24, GAPS = 0.8;  // how much darker it is between locks, and how soon along them it comes to that
const float APART = 0.8;      // from here on locks narrow towards their tips

float scattered(float number) {
    float at = fract(0.1031 * number + 0.37 * floor(strand.w));
    at *= at + 33.33;
    return fract(2.0 * at * at);
}

// How much is seen of what differs from one to the next where a pixel holds so many.
float seen(float pixel) {
    return clamp(1.5 - 1.5 * pixel, 0.0, 1.0);
}

// From one strand of hairs to the next, 0..1; their mean where they are not seen.
float varied(float hairs, float visible) {
    float low = floor(hairs);
    return mix(0.5, mix(scattered(low), scattered(low + 1.0), smoothstep(0.0, 1.0, hairs - low)), visible);
}

void main() {
    float along = strand.y, number = floor(strand.x), lock = 2.0 * (strand.x - number) - 1.0, own = scattered(3.0 * number + 1.0);
    float card = step(CARDS, strand.x), many = mix(HAIRS, CARD_HAIRS, card);
    // wisps are narrower to one side of a lock
    float hairs = many * (strand.x + UNEQUAL * (own - 0.5) * (1.0 - lock * lock)) + 0.8 * drift.r, wisp = hairs / WISP;
    vec2 pixel = vec2(many, 1.0) * fwidth(spread) + 1e-4;
    float hair_seen = seen(pixel.x), wisp_seen = seen(pixel.x / WISP), unseen = 1.0 - hair_seen;
    float here = varied(hairs, hair_seen), ends = varied(wisp + 7.0, wisp_seen), point = wisp_seen * abs(2.0 * fract(wisp) - 1.0);
    float narrow = mix(1.4, 0.82, card * smoothstep(0.0, 0.2, along)) - (0.04 + 0.14 * own) * smoothstep(APART, 1.0, along);
    float edge = EDGE * (strand.x - CARDS * card) * (1.2 - along) + 0.8 * along + 1.2 * drift.g;   // fewer hairs frame the face
    float last = 1.0 - TIP * (0.45 * own + 0.45 * ends * ends + 0.50 * here * here);
    narrow *= min((last - along) / TIP + mix(1.0, BLUNT, card), 1.0);   // a lock as a whole ends in a point
    vec4 within = vec4(edge + mix(0.2, -0.1, card) - here, (last - along) / (0.4 * TIP) - POINTED * (0.5 + 0.9 * ends) * point, narrow + 0.32 * here - abs(lock), along - ROOT * mix(SHEET_ROOT, 1.0, card) * (1.3 * here + 0.6 * ends - 0.4));
    vec4 soft = vec4(min(EDGE / many * pixel.x, 0.3) + 0.5 * unseen, pixel.y / (0.4 * TIP) + POINTED * min(2.0 / WISP * pixel.x, 0.5) + 0.1 * unseen, 2.0 / many * pixel.x + 0.3 * unseen, pixel.y + (0.3 + unseen) * ROOT);
    vec4 covered = clamp(0.5 + within / soft, 0.0, 1.0);
    float cover = min(min(covered.x, covered.y), min(covered.z, covered.w));
    if (cover < least_cover) discard;
    float strands = 0.35 * ends + 0.65 * here;
    float gap = 1.0 - min(GAPS * along, GAP) * smoothstep(0.2, 1.0, abs(lock));
    float light = (0.76 + 0.48 * strands + 0.40 * drift.b) * gap;
    colour = vec4(mix(dull, bright, strands) * light, least_cover < 0.5 ? cover : 1.0);   // with one sample a pixel there is hair or none
}
