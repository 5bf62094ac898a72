// Light on hair: Kajiya and Kay 1989, with a white and a coloured highlight.
vec3 hair_light(vec3 base, vec3 along, vec3 n, vec3 view, float gloss, float spread, float cover) {
    vec3 total = base * hemisphere(n) * cover;
    for (int i = 0; i < LIGHTS; i++) {
        vec3 l = light_direction[i].xyz, h = normalize(l + view);
        float t_l = dot(along, l), facing = clamp(0.65 * dot(n, l) + 0.35, 0.0, 1.0);
        float first = dot(along, h) - 0.08 + spread, second = dot(along, h) + 0.11 + spread;
        float white = pow(max(1.0 - first * first, 0.0), 32.0), coloured = pow(max(1.0 - second * second, 0.0), 9.0);
        float body = sqrt(max(1.0 - t_l * t_l, 0.0));
        total += light_colour[i].rgb * facing * cover * (base * 0.8 * body + gloss * (0.07 * white + 1.3 * base * coloured));
    }
    return total;
}
