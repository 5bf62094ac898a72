#version 330 core
// Teeth, gums and tongue.
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "develop.glsl"
centroid in vec3 position, normal, rest_position;
centroid in vec4 matter;   // tooth; how dark and yellow it is; tongue; of the key light what goes round in the mouth
centroid in vec2 within;   // on a tooth: across, -1 and 1 where the next ones meet it, up 0 (edge)..1 (gum)
centroid in vec4 reach;    // of the surroundings' light and the key light what arrives; how far behind the lips; 0 at their edges .. 1 clear of them
out vec4 colour;

uniform vec3 teeth;
uniform float mouth_pursed;   // how much narrower than at rest the mouth is, 1 from a tenth on
uniform float shaded;   // how much less light the lower jaw gets, in the lips' shadow

const vec3 GUM = vec3(0.34, 0.175, 0.16), TONGUE = vec3(0.46, 0.19, 0.17);
const vec3 WALLS = vec3(0.50, 0.29, 0.24);   // the colour of what they send back
const vec3 BEHIND_LIPS = vec3(0.86, 0.60, 0.52);
const vec3 OLD = vec3(0.84, 0.76, 0.62), NECK = vec3(0.93, 0.82, 0.69);   // of the colour of the whitest front tooth's middle
const vec3 EDGE = vec3(0.84, 0.85, 0.85);    // of its green: enamel alone is grey and blue
const vec3 GAP = vec3(0.42, 0.31, 0.25);     // of the light on a tooth, what is left where the next one meets it
const vec3 LIP_SHADE = vec3(0.30, 0.23, 0.20);   // of the light on a tooth that a lip lies on: what it lets through is red
const float GAP_FROM = 0.79, EDGE_GAP = 0.24;    // across, where teeth begin to shade each other; how much sooner at their round corners
const float LIT = 0.48;   // of the key light on enamel, what does not go on into the tooth
const vec2 TURNED = vec2(0.35, 0.75);   // of the light in the mouth, what arrives at a tooth or gum that is turned away from the lips, and at the tongue, whose palate sends some down

// The colour of a tooth; the gum lies on it in a bow.
vec3 enamel(out float gum) {
    float up = within.y, aside = within.x * within.x, old = matter.y;
    float corner = smoothstep(0.20, 0.0, up), line = 0.93 - 0.13 * min(aside, 1.0);
    vec3 c = teeth * mix(vec3(1.0), OLD, old) * mix(vec3(1.0), NECK, smoothstep(0.25, 0.95, up));
    c = mix(c, teeth.g * EDGE, 0.65 * (1.0 - old) * smoothstep(0.18, 0.02, up));   // the edge lets light through
    c *= mix(vec3(1.0), GAP, smoothstep(GAP_FROM - EDGE_GAP * corner * corner, 1.0, abs(within.x)));
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
    vec3 albedo = matter.x * tooth + (1.0 - matter.x - tongue) * GUM + tongue * TONGUE * (1.0 - 0.12 * groove) * mix(0.72, 1.0, smoothstep(-0.006, 0.0, reach.z));
    albedo *= mix(0.88 + 0.24 * grain.r, 0.98 + 0.04 * grain.r, enamelled);
    float rough = mix(0.32, 0.24, enamelled), sky_part = min(reach.x * mix(2.0 - 0.7 * tongue, 1.9, enamelled), 1.0), key_part = reach.y;   // teeth light each other
    float inside = smoothstep(-0.006, 0.0, reach.z), towards_lips = mix(mix(TURNED.x, TURNED.y, tongue), 1.0, max(dot(n, head[2].xyz), 0.0));
    sky_part *= mix(1.0, towards_lips, inside);
    // what the walls send back is red and dies away behind
    vec3 walls = WALLS * sky_part * inside * exp(-reach.z / 0.016);
    vec3 light = hemisphere(n) * sky_part + walls, gloss = vec3(0.0);
    vec3 round_light = WALLS * light_colour[0].rgb * (matter.w * (1.0 + 0.7 * enamelled) * inside * towards_lips);
    float n_v = max(dot(n, view), 0.02);
    for (int i = 0; i < 2; i++) {
        vec3 l = light_direction[i].xyz, h = normalize(l + view);
        float n_l = max(dot(n, l), 0.0), part = i == 0 ? key_part * mix(sky_part, 1.0, 0.45) : sky_part;
        light += (i == 0 ? mix(1.0, LIT, enamelled) : 1.0) * part * light_colour[i].rgb * wrapped(vec3(dot(n, l)), mix(vec3(0.40, 0.26, 0.22), vec3(0.42, 0.38, 0.34), enamelled));
        gloss += part * mix(sky_part, 1.0, 0.4) * light_colour[i].rgb * ggx(max(dot(n, h), 0.0), rough) * visibility(n_l, n_v, rough) * fresnel(0.045, max(dot(view, h), 0.0)) * n_l * PI;
    }
    gloss += sky_part * hemisphere(reflect(-view, n)) * fresnel(0.045, n_v) * 0.8;
    vec3 lip = mix(LIP_SHADE, vec3(1.0), mix(1.0, smoothstep(0.05, 0.85, reach.w), max(inside * (1.0 - tongue), enamelled)));
    // pursed lips shade the teeth behind them, and colour what reaches these
    albedo *= mix(vec3(1.0), BEHIND_LIPS, enamelled * mouth_pursed * smoothstep(0.0095, 0.0145, reach.z));
    colour = vec4(finish((1.0 - shaded * inside) * lip * (albedo * (light + round_light) + gloss)), 1.0);
}
