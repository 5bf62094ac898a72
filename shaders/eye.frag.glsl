#version 330 core
#include "frame.glsl"
#include "shading.glsl"
#include "noise.glsl"
#include "develop.glsl"
#include "eye_paint.glsl"
centroid in vec3 position, local, local_normal;
out vec4 colour;

uniform mat4 turned;
uniform vec3 centre;        // in the scene
uniform float radius;
uniform vec3 upper_lid;     // height over x as a parabola, in radii, in the head's axes
uniform vec3 lower_lid;
uniform vec2 corners;       // x of the canthi in radii, the smaller first
const vec3 CARUNCLE = vec3(0.50, 0.21, 0.18);
const vec3 FLUSHED = vec3(0.90, 0.60, 0.52);   // of the white's colour, what the corners leave
const vec2 LAMP = vec2(0.02, 0.045), WINDOW = vec2(0.10, 0.15);   // half the sides of what the cornea mirrors
const float LAMP_SOFT = 0.16, WINDOW_SOFT = 0.05, BAR = 0.018;
const float LAMP_BRIGHT = 9.0, WINDOW_BRIGHT = 2.2, SKY_BRIGHT = 0.7;
const float WHITE_LIT = 0.72;  // of the light, what brow and nose leave
const float TEARS = 0.085;     // of the light, what the tears' edge along the lower lid sends back

// A picture with soft, round corners in the mirror.
float mirrored(vec2 at, vec2 half_size, float soft) {
    return smoothstep(soft, -0.2 * soft, length(max(abs(at) - half_size, 0.0)));
}

void main() {
    mat3 axes = mat3(turned) / radius;
    vec3 view = normalize(eye_point.xyz - position), n = normalize(axes * local_normal);
    // the iris lies flat behind the cornea, which refracts
    vec3 ray = refract(-transpose(axes) * view, normalize(local_normal), 1.0 / 1.336);
    float depth = sqrt(1.0 - iris_radius * iris_radius) - 0.02;
    vec3 at = local + ray * max((depth - local.z) / min(ray.z, -0.05), 0.0);
    float edge = length(local.xy), ri = length(at.xy) / iris_radius;
    float on_iris = iris_cover(local);
    vec2 spoke = at.xy / max(length(at.xy), 1e-4);
    vec3 iris = iris_colour(at.xy), white = white_colour(local.xy);

    vec3 q = transpose(mat3(head)) * (position - centre) / radius;
    float over = dot(upper_lid, vec3(1.0, q.x, q.x * q.x)) - q.y, under = q.y - dot(lower_lid, vec3(1.0, q.x, q.x * q.x));
    float from_corner = min(q.x - corners.x, corners.y - q.x);
    float nasal = dot(centre, head[0].xyz) > 0.0 ? q.x - corners.x : corners.y - q.x;
    float flesh = smoothstep(0.30, 0.17, nasal + 0.9 * abs(q.y + 0.10));   // the caruncle
    white = mix(white, CARUNCLE, flesh);
    // the lids keep light off, most the upper one with its lashes; the globe turns away to the corners
    float shade = mix(0.12, 1.0, smoothstep(0.0, 0.32, over)) * mix(0.66, 1.0, smoothstep(0.05, 0.60, over)) * mix(0.60, 1.0, smoothstep(-0.04, 0.20, under));
    shade *= mix(0.46, 1.0, max(smoothstep(-0.05, 0.50, from_corner), 0.55 * flesh));
    float turned_away = smoothstep(0.70, 0.98, abs(q.x)) * (1.0 - flesh);
    shade *= 1.0 - 0.40 * turned_away;
    white *= mix(vec3(1.0), FLUSHED, max((1.0 - flesh) * smoothstep(0.55, 0.0, from_corner), turned_away));
    vec3 ns = normalize(mix(n, mat3(head)[2], 0.15));
    n = normalize(n + flesh * (mat3(head) * vec3(0.9 * sign(q.x) * (0.12 - nasal) * 6.0, -5.0 * (q.y + 0.10), 0.0)));
    vec3 light = hemisphere(ns), behind = 0.75 * hemisphere(n), shine = vec3(0.0);
    vec3 mirror = reflect(-view, n);
    float bright = fresnel(0.028, max(dot(n, view), 0.35));
    vec3 key = transpose(axes) * light_direction[0].xyz;
    float caustic = 1.0 + 0.9 * smoothstep(-0.2, 1.0, dot(spoke, -normalize(key.xy + 1e-4))) * smoothstep(0.2, 1.0, ri);
    for (int i = 0; i < 2; i++) {
        vec3 l = light_direction[i].xyz;
        light += light_colour[i].rgb * wrapped(vec3(dot(ns, l)), vec3(0.3));
        behind += light_colour[i].rgb * 0.52 * (i == 0 ? caustic : 1.0);
        vec3 x = normalize(cross(vec3(0.0, 1.0, 0.0), l)), y = cross(l, x);
        vec2 b = vec2(dot(mirror, x), dot(mirror, y)), bars = smoothstep(0.3 * BAR, 1.7 * BAR, abs(b));
        float lamp = i == 0 ? LAMP_BRIGHT * mirrored(b, LAMP, LAMP_SOFT) : WINDOW_BRIGHT * bars.x * bars.y * mirrored(b, WINDOW, WINDOW_SOFT);
        shine += light_colour[i].rgb * (step(0.0, dot(mirror, l)) * lamp);
    }
    shine += hemisphere(mirror) * SKY_BRIGHT * smoothstep(-0.1, 0.5, mirror.y);
    vec3 c = mix(white * light * WHITE_LIT, iris * behind, on_iris) * shade;
    // the tears' edge along the lower lid
    c += TEARS * (light_colour[0].rgb + light_colour[1].rgb) * exp(-pow((under - 0.035) / 0.020, 2.0)) * smoothstep(0.12, 0.40, from_corner) * smoothstep(0.05, 0.2, over);
    c += shine * bright * smoothstep(0.02, 0.25, from_corner) * smoothstep(0.0, 0.10, over) * mix(0.6, 1.0, on_iris) * smoothstep(-0.02, 0.06, under);
    colour = vec4(finish(c), 1.0);
}
