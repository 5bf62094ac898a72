// What the skin is like at a vertex or a pixel: its colour, and how much light gets there.
uniform vec3 skin_tone;
uniform vec3 lip_tint;
uniform vec3 hair_colour;
uniform float shine;
uniform float light_width;   // 0..1, of all but the key light

const float HIDDEN = 0.875;   // of the skin, under dense hair
const vec3 WRAP = vec3(0.23, 0.195, 0.175);  // how far light goes round the terminator, by channel
const vec3 BLED = vec3(0.15, 0.125, 0.12), BOUNCED = vec3(0.32, 0.17, 0.12);   // of the key light, of the surroundings'
const vec3 RIM_WRAP = vec3(0.1);
const vec3 SCATTERED = vec3(0.48, 0.40, 0.34);  // how far light goes through the skin, by channel
const float FILL_OPEN = 0.4, RIM_OPEN = -0.2;   // how far past what they graze lights without shadows arrive
const float RIM_GLOSS = 0.6;     // of the sheen that light from behind makes, what fine hairs on the skin leave
const float CHEEK_HIDES = 0.8;   // of the light from behind, what cheeks keep off the lips
const float ROUGH_DULLS = 0.5;   // of the sheen of wide light that grazes the skin, what its grain takes
const vec3 SALLOW = vec3(1.0, 0.99, 0.92);   // where skin is oily it is thick and yellow
const vec3 LIP_SKIN = vec3(0.77, 0.56, 0.58), UPPER_LIP = vec3(0.81, 0.82, 0.82);
const float UPPER_DULL = 0.55;   // of the gloss of lips, what the upper one lacks
const vec3 INNER_LIP = vec3(0.78, 0.58, 0.60);
const vec2 F0 = vec2(0.026, 0.036);  // of skin that is dry and moist

// The skin's colour: tint is redness, darker skin, gloss, under the hair; blotches 0..1 is even at 0.5.
vec3 complexion_colour(vec4 tint, float mouth, float wet, float blotches) {
    vec3 c = skin_tone * mix(vec3(1.0), vec3(1.04, 0.94, 0.92), clamp(2.0 * blotches - 0.5, 0.0, 1.0));
    c *= mix(vec3(1.0), tint.x < 0.0 ? vec3(0.72, 0.74, 0.80) : vec3(1.03, 0.76, 0.74), abs(tint.x) * (0.8 * blotches + 0.6));
    c *= mix(vec3(1.0), vec3(0.94, 0.92, 0.93), tint.y) * mix(vec3(1.0), SALLOW, tint.z);
    c = mix(c, vec3(0.29, 0.105, 0.09), mouth);
    c = mix(c, mix(skin_tone, vec3(0.60, 0.30, 0.26), 0.45) * vec3(0.98, 0.86, 0.84), 0.8 * wet);
    return mix(c, hair_colour, HIDDEN * tint.w);
}

// Lips are darker and redder to the inside, where at rest no light arrives; the upper one is browner.
vec3 lip_colour(float ambient, float upper) {
    return mix(skin_tone * LIP_SKIN, lip_tint, 0.35) * mix(vec3(1.0), UPPER_LIP, upper) * mix(INNER_LIP, vec3(1.0), smoothstep(0.0, 1.0, ambient));
}

// The red goes over into the skin unevenly; mottle -0.5..0.5.
float lip_share(float red, float mottle) {
    return smoothstep(0.12, 0.86, red + 0.34 * mottle);
}

// How much paler the skin is along the lips' border.
float lip_ridge(float red) {
    return 0.05 * smoothstep(0.0, 0.10, red) * smoothstep(0.55, 0.15, red);
}

// Light that misses the surface bleeds through it and goes round in folds, red more; parts by channel.
vec3 bled(float light, vec3 parts) {
    return mix(vec3(light), vec3(sqrt(light)), parts);
}

// Cosines of a light for the channels: red follows the blurred normal, blue the sharp one.
vec3 scattered(vec3 sharp, vec3 soft, vec3 l) {
    return mix(vec3(dot(sharp, l)), vec3(dot(soft, l)), SCATTERED);
}

float roughness(float gloss, float lip, float moist) {
    return mix(mix(mix(0.60, 0.46, gloss), 0.50, lip), 0.27, moist);
}

// How much of the shine is seen.
float sheen(float ambient, float mouth, float covered, float moist) {
    return clamp(1.2 * max(ambient, 0.2 * mouth) - 0.15, 0.0, 1.0) * (1.0 - 0.9 * mouth) * (1.0 - 0.8 * covered) * mix(shine, 1.0, moist);
}

// The gloss of one light on one lobe.
float glint(vec3 n, vec3 l, vec3 view, float n_v, float rough, float f0) {
    vec3 h = normalize(l + view);
    float n_l = max(dot(n, l), 0.0);
    return PI * n_l * ggx(max(dot(n, h), 0.0), rough) * visibility(n_l, n_v, 0.9 * rough) * fresnel(f0, max(dot(view, h), 0.0));
}

// How wide the sources of all but the key light are for dry skin: their gloss lies on its blurred shape, not on each edge.
float sky_wide(float lip, float moist) {
    return light_width * (1.0 - max(lip, moist));
}

// How much of a light without a shadow of its own arrives: what lies round about hides what it cannot see itself.
float unhidden(vec3 soft, vec3 l, float opened) {
    return clamp(1.6 * dot(soft, l) + opened, 0.0, 1.0);
}
