// Light on hair: Kajiya and Kay 1989, with the two highlights and the light through the fibre of Marschner et al. 2003.
vec3 hair_light(vec3 base, vec3 along, vec3 n, vec3 view, float gloss, float spread, float cover) {
    vec3 total = base * hemisphere(n) * cover;
    for (int i = 0; i < LIGHTS; i++) {
        vec3 l = light_direction[i].xyz, h = normalize(l + view);
        float t_l = dot(along, l), facing = clamp(0.70 * dot(n, l) + 0.30, 0.0, 1.0);
        float first = dot(along, h) - 0.09 + spread, second = dot(along, h) + 0.13 + spread;
        float w = max(1.0 - first * first, 0.0), c = max(1.0 - second * second, 0.0);
        w *= w; w *= w; w *= w; w *= w; w *= w;   // to the power of 32
        c *= c; c *= c; c *= c;                   // of 8
        float body = sqrt(max(1.0 - t_l * t_l, 0.0)), through = max(-dot(view, l), 0.0);
        vec3 light = base * 0.8 * body + gloss * (0.085 * w + 1.2 * base * c) + gloss * 1.6 * base * through * through * body;
        total += light_colour[i].rgb * facing * cover * light;
    }
    return total;
}
