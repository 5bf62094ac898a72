// The colours of an eyeball, without light: of its iris, which lies flat behind the cornea, and of its white.
uniform vec3 iris_inner, iris_outer;
uniform float iris_radius, pupil_radius;   // in radii; in radii of the iris
uniform float dilation;     // the pupil's diameter over that at rest
uniform vec3 sclera;

const float WIDEST_PUPIL = 0.80;   // in radii of the iris

// How much of the iris is seen at a place on the eyeball.
float iris_cover(vec3 local) {
    return smoothstep(iris_radius + 0.02, iris_radius - 0.03, length(local.xy)) * step(0.0, local.z);
}

// The iris at a place of its disc, which is iris_radius large.
vec3 iris_colour(vec2 at) {
    float ri = length(at) / iris_radius;
    vec2 spoke = at / max(length(at), 1e-4);
    float fibres = 0.45 * noise(vec3(spoke * 2.3, 0.25 * ri)).r + 0.55 * noise(vec3(spoke * 5.3, 0.5 * ri)).g;
    float pupil = min(pupil_radius * dilation, WIDEST_PUPIL);
    float collar = exp(-pow((ri - pupil - 0.16) / 0.13, 2.0));   // the collarette, lighter
    vec3 iris = mix(iris_outer, iris_inner, smoothstep(0.28, 0.70, fibres + 0.10 * collar)) * mix(1.15, 0.70, smoothstep(0.42, 0.95, ri));
    iris *= (0.85 + 0.30 * collar) * (1.0 - 0.88 * smoothstep(0.72, 1.02, ri));
    return iris * smoothstep(pupil, pupil + 0.06, ri);
}

// The white of the eye beside the iris.
vec3 white_colour(vec2 local) {
    float side = length(local);
    float veins = smoothstep(0.60, 0.72, noise(vec3(local * vec2(0.35, 1.4), 0.3)).g) * smoothstep(0.50, 0.85, side);
    vec3 white = mix(sclera, sclera * vec3(0.93, 0.66, 0.59), 0.6 * smoothstep(0.45, 0.95, side) + 0.5 * veins);
    return white * (1.0 - 0.35 * smoothstep(iris_radius + 0.10, iris_radius, side));
}
