// The colours of an eyeball, without light: of its iris, which lies flat behind the cornea, and of its white.
uniform vec3 iris_inner, iris_outer;
uniform float iris_radius, pupil_radius;   // in radii; in radii of the iris
uniform float dilation;     // the pupil's diameter over that at rest
uniform vec3 sclera;

const float WIDEST_PUPIL = 0.80;   // in radii of the iris
const float LIMBUS = 0.038;        // radii: how softly the white goes over into the cornea, to both sides
const vec3 LIMBAL = vec3(0.66, 0.68, 0.74);   // of the white's colour, what the iris under it leaves there
const vec3 BLOODSHOT = vec3(0.95, 0.72, 0.66), VEIN = vec3(0.86, 0.46, 0.40);   // of the white's colour, far from the iris
const float RIM = 0.30;            // of the iris's colour, what is left in its dark ring

// How much of the iris is seen at a place on the eyeball.
float iris_cover(vec3 local) {
    return smoothstep(iris_radius + LIMBUS, iris_radius - LIMBUS, length(local.xy)) * step(0.0, local.z);
}

// The iris at a place of its disc, which is iris_radius large.
vec3 iris_colour(vec2 at) {
    float ri = length(at) / iris_radius;
    vec2 spoke = at / max(length(at), 1e-4);
    vec4 patches = noise(vec3(1.6 * at, 0.7));
    spoke += 0.07 * (patches.g - 0.5) * vec2(-spoke.y, spoke.x);   // no fibre is straight
    float fibres = 0.55 * noise(vec3(spoke * 2.9, 0.30 * ri)).r + 0.45 * noise(vec3(spoke * 6.7, 0.45 * ri)).g;
    float pupil = min(pupil_radius * dilation, WIDEST_PUPIL);
    float collar = exp(-pow((ri - pupil - 0.17) / 0.12, 2.0));   // the collarette, lighter
    float part = 0.46 + 1.5 * (fibres - 0.5) + 0.5 * (patches.r - 0.5) + 0.34 * collar;
    vec3 iris = mix(iris_outer, iris_inner, clamp(part, 0.0, 1.2)) * mix(1.05, 0.72, smoothstep(0.40, 0.85, ri));
    iris *= mix(1.0, RIM, smoothstep(0.70, 0.98, ri));
    return iris * smoothstep(pupil - 0.02, pupil + 0.07, ri);
}

// The white of the eye beside the iris.
vec3 white_colour(vec2 local) {
    float side = length(local), away = smoothstep(iris_radius + 0.05, 0.92, side);
    vec4 tangle = noise(vec3(0.9 * local / max(side, 1e-4), 0.45 * side)), wave = noise(vec3(1.3 * local, 0.1));
    float along = tangle.g + 0.22 * (wave.g - 0.5);   // veins come from the edge, winding
    float veins = smoothstep(0.028, 0.0, abs(along - 0.5)) * smoothstep(0.36, 0.60, wave.r) * away;
    vec3 white = sclera * mix(vec3(1.0), BLOODSHOT, away * (0.75 + 0.8 * (wave.r - 0.5)));
    white *= mix(vec3(1.0), VEIN, 0.75 * veins);
    return white * mix(vec3(1.0), LIMBAL, smoothstep(iris_radius + 0.13, iris_radius - 0.02, side));
}
