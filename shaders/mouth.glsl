// How much light gets into the mouth, from the opening between the lips of this frame.
uniform float mouth_light;   // how much light the lips let in
uniform vec2 mouth_bow;       // how far behind the middle the corners are, and how much higher, metres
uniform vec4 mouth_opening;  // heights of the upper and the lower lip's edge, half the width, z; in the head's axes, metres

const float LIP_SHADES = 0.0060;   // metres from a lip's edge to where it shades teeth no more, if the mouth is open wide
const float LOWER_CLEAR = 0.45;    // how much clearer the edge of the lower lip is, which has light above it
const vec3 LIP_GLOW = vec3(0.165, 0.082, 0.074);   // of the light on lips, what goes through them to where they shade themselves
const float CHEEKS = 0.26;   // of the light on the teeth, what they send to the cheeks beside them
const float ROUND = 0.16;    // of the key light on an open mouth, what goes round in it from wall to wall
const float FADES_FROM = 0.003, FADES_OVER = 0.010;   // metres behind the lips, where the walls begin to close off the light, and how fast
const float THROAT = 0.22;   // of the light, what is left however far behind
const float BOW_COUNTS = 0.5;   // of how far the corners lie behind the middle: the light that passes there has passed the cheeks

// How far behind the lips a place is.
float mouth_depth(vec3 at) {
    float aside = at.x / mouth_opening.z;
    return mouth_opening.w - mouth_bow.x * min(aside * aside, 1.6) - at.z;
}

// How much light the walls leave to a place behind the lips.
float mouth_fade(vec3 at, float from, float over) {
    float aside = at.x / mouth_opening.z;
    float behind = mouth_depth(at) + BOW_COUNTS * mouth_bow.x * min(aside * aside, 1.6);
    return mix(THROAT, 1.0, exp(-max(behind - from, 0.0) / over));
}

// How far inside the opening a place is seen, from the nearer lip's edge, 0, to where that shades no more, 1.
float mouth_clear(vec3 at) {
    float aside = min(at.x * at.x / (mouth_opening.z * mouth_opening.z), 1.2), bow = mouth_bow.y * aside;
    float middle = 0.5 * (mouth_opening.x + mouth_opening.y), high = 0.5 * (mouth_opening.x - mouth_opening.y) * (1.0 - min(aside, 1.0));
    float shaded = clamp(0.45 * (mouth_opening.x - mouth_opening.y), 0.0008, LIP_SHADES);
    float up = at.y - middle - bow;
    return (high - abs(up)) / shaded + (up < 0.0 ? LOWER_CLEAR : 0.0);
}

// Of the key light what goes round in the mouth to where the walls leave that part.
float mouth_round(float fade) {
    return ROUND * mouth_light * fade;
}

// How much light the walls leave to a place on themselves.
float wall_fade(vec3 at) {
    return mouth_fade(at, FADES_FROM, FADES_OVER);
}

// At a place in the head's axes: the parts of the surroundings' light and of the key light that arrive.
vec2 mouth_reach(vec3 at) {
    float wide = mouth_opening.z, depth = max(mouth_depth(at) - 0.0015, 0.0) + 0.0012;
    float aside = min(at.x * at.x / (wide * wide), 1.2), middle = 0.5 * (mouth_opening.x + mouth_opening.y) + mouth_bow.y * aside, half_height = max(0.5 * (mouth_opening.x - mouth_opening.y), 0.0002);
    float high = half_height * max(1.0 - aside * aside, 0.2), y = at.y - middle;
    // of a slit one sees the difference of the sines of the angles to its edges
    vec4 edges = vec4(high - y, high + y, wide - at.x, wide + at.x), sines = edges * inversesqrt(edges * edges + depth * depth);
    float sky = 0.25 * max(sines.x + sines.y, 0.0) * max(sines.z + sines.w, 0.0);
    vec3 l = transpose(mat3(head)) * light_direction[0].xyz;
    vec2 hit = at.xy + depth / max(l.z, 0.3) * l.xy;
    float room = min(high - abs(hit.y - middle), wide - abs(hit.x)), soft = 0.0015 + 0.12 * depth;
    return vec2(sky, smoothstep(-soft, soft, room) * clamp(high / 0.003, 0.0, 1.0));
}

// How much of a lip is lit as what is seen of it at rest: its inside lies against the teeth.
float lip_outer(float lip, float within) {
    return lip * (1.0 - 0.7 * smoothstep(0.0, 0.35, within));
}

// How much of the surroundings' light arrives; inside the mouth as the lips let in.
float sky_light(float ambient, float lip, float mouth, float wet, vec3 at) {
    float light = max(max(ambient, mix(0.40, 0.80, mouth_light) * lip), 0.45 * wet);
    float behind = max(mouth_depth(at), 0.0), inside = mouth_reach(at).x * (0.08 + exp(-max(behind - 0.010, 0.0) / 0.016));
    inside += CHEEKS * mouth_light * exp(-behind / 0.012);
    return mix(light, inside * wall_fade(at), mouth);
}

// What gets through and between lips of the key light where they keep it off themselves: less where they touch.
vec3 lip_glow(float lip, float ambient, float lit) {
    return lip * mix(smoothstep(-0.80, 0.70, ambient), 0.6, mouth_light) * (1.0 - lit) * LIP_GLOW * light_colour[0].rgb;
}
