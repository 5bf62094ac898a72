#version 330 core
// Teeth, gums and tongue.
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "develop.glsl"
centroid in vec3 position, normal, rest_position;
centroid in vec4 matter;   // tooth, gum, tongue; of the key light what goes round in the mouth
centroid in vec2 within;   // on a tooth: across -1..1, up 0 (edge)..1 (gum)
centroid in vec4 reach;    // of the surroundings' light and the key light what arrives; how far behind the lips; 0 at their edges .. 1 clear of them
out vec4 colour;

uniform vec3 teeth;
uniform float mouth_pursed;   // how much narrower than at rest the mouth is, 1 from a tenth on
uniform float shaded;   // how much less light the lower jaw gets, in the lips' shadow

const vec3 GUM = vec3(0.42, 0.20, 0.185), TONGUE = vec3(0.47, 0.165, 0.155);
const vec3 WALLS = vec3(0.60, 0.27, 0.20);   // the colour of what they send back
const vec3 BEHIND_LIPS = vec3(0.86, 0.60, 0.52);
const vec3 MOLAR = vec3(0.82, 0.70, 0.56), NECK = vec3(0.95, 0.86, 0.74);   // of the colour of a front tooth's middle
const vec3 LIP_SHADE = vec3(0.66, 0.50, 0.44);   // of the light on a tooth that a lip lies on: what it lets through is red

// The colour of a tooth; the gum lies on it in a bow.
vec3 enamel(out float gum) {
    float up = within.y, aside = within.x * within.x;
    vec3 c = mix(teeth, teeth * NECK, smoothstep(0.25, 0.95, up)) * mix(vec3(1.0), MOLAR, smoothstep(0.010, 0.032, reach.z));
    c *= 1.0 + 0.14 * (noise(rest_position * vec3(26.0, 8.0, 26.0)).r - 0.5);   // no two teeth are alike
    c = mix(c, 0.74 * teeth.ggg, 0.40 * smoothstep(0.16, 0.0, up));   // the edge lets light through
    c *= mix(vec3(1.0), vec3(0.80, 0.70, 0.60), smoothstep(0.72, 1.0, aside));   // between the teeth
    float line = 0.93 - 0.13 * aside;
    gum = smoothstep(line - 0.03, line + 0.03, up);
    return mix(c * mix(1.0, 0.80, smoothstep(line - 0.16, line, up)), GUM, gum);
}

void main() {
    vec3 view = normalize(eye_point.xyz - position), n = normalize(normal);
    n = dot(n, view) < 0.0 ? -n : n;
    vec4 grain = noise(rest_position * 150.0);
    float tongue = matter.z, groove = exp(-pow(rest_position.x / 0.0030, 2.0)), gummed;
    vec3 tooth = enamel(gummed);
    float enamelled = matter.x * (1.0 - gummed);
    n = normalize(n + (0.03 * enamelled + 0.14 * (1.0 - enamelled) * (1.0 - tongue) + 0.34 * tongue) * (grain.bag - 0.5));
    vec3 albedo = matter.x * tooth + matter.y * GUM + tongue * TONGUE * (1.0 - 0.12 * groove) * mix(0.72, 1.0, smoothstep(-0.006, 0.0, reach.z));
    albedo *= mix(0.88 + 0.24 * grain.r, 0.98 + 0.04 * grain.r, enamelled);
    float rough = mix(0.32, 0.24, enamelled), sky_part = min(reach.x * mix(2.0 - 0.7 * tongue, 1.55, enamelled), 1.0), key_part = reach.y;   // teeth light each other
    // what the walls send back is red and dies away behind
    float inside = smoothstep(-0.006, 0.0, reach.z);
    vec3 walls = WALLS * sky_part * inside * exp(-reach.z / 0.016);
    vec3 light = hemisphere(n) * sky_part + walls, gloss = vec3(0.0);
    vec3 round_light = WALLS * light_colour[0].rgb * (matter.w * (1.0 + 0.7 * enamelled) * inside * (0.75 + 0.25 * n.y));
    float n_v = max(dot(n, view), 0.02);
    for (int i = 0; i < 2; i++) {
        vec3 l = light_direction[i].xyz, h = normalize(l + view);
        float n_l = max(dot(n, l), 0.0), part = i == 0 ? key_part * mix(sky_part, 1.0, 0.45) : sky_part;
        light += part * light_colour[i].rgb * wrapped(vec3(dot(n, l)), mix(vec3(0.40, 0.26, 0.22), vec3(0.42, 0.38, 0.34), enamelled));
        gloss += part * mix(sky_part, 1.0, 0.4) * light_colour[i].rgb * ggx(max(dot(n, h), 0.0), rough) * visibility(n_l, n_v, rough) * fresnel(0.045, max(dot(view, h), 0.0)) * n_l * PI;
    }
    gloss += sky_part * hemisphere(reflect(-view, n)) * fresnel(0.045, n_v) * 0.8;
    float back = 0.16 + 0.84 * exp(-max(reach.z - 0.014, 0.0) / mix(0.016, 0.022, tongue));   // it is dark in the throat
    light *= mix(LIP_SHADE, vec3(1.0), mix(1.0, smoothstep(-0.2, 1.0, reach.w), inside * (1.0 - tongue)));
    // pursed lips shade the teeth behind them, and colour what reaches these
    albedo *= mix(vec3(1.0), BEHIND_LIPS, enamelled * mouth_pursed * smoothstep(0.0095, 0.0145, reach.z));
    colour = vec4(finish((1.0 - shaded * inside) * (albedo * (light * mix(back, 1.0, 0.25 * enamelled) + round_light) + gloss * back)), 1.0);
}
