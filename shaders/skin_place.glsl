// Where a vertex of the skin is.
in ivec2 ends;         // the skin vertices between which this one lies
in vec3 rest;          // at rest, metres
in vec3 soft_normal;   // at rest, blurred
in vec3 rest_normal;
in vec4 material;      // lip, inside of the mouth, wet lid margin, ear
in vec4 complexion;    // redness, darker (sockets, upper lip), gloss, under the hair
in float ambient;      // how much of the surroundings' light arrives

const float MOUTH_BEHIND = 0.007;  // metres

// The inside of the mouth follows the lips less than the lips move: it must not hide the teeth.
vec4 skin_clip(vec3 placed) {
    vec4 clip = view_projection * vec4(placed, 1.0);
    vec4 behind = view_projection * vec4(placed + MOUTH_BEHIND * material.y * normalize(placed - eye_point.xyz), 1.0);
    clip.z = behind.z / behind.w * clip.w;
    return clip;
}
