// Light on hair: Kajiya and Kay 1989, with the two highlights and the light through the fibre of Marschner et al. 2003.
struct HairLight {
    vec3 body;         // scattered
    vec3 shine, other; // the two highlights, of hairs whose scales lie at either angle
};

// ``angles`` at which the scales of two hairs side by side lie.
HairLight hair_lights(vec3 base, vec3 along, vec3 n, vec3 view, float gloss, vec2 angles, float cover) {
    HairLight total = HairLight(base * hemisphere(n) * cover, vec3(0.0), vec3(0.0));
    for (int i = 0; i < LIGHTS; i++) {
        vec3 l = light_direction[i].xyz, h = normalize(l + view);
        float t_l = dot(along, l), facing = clamp(0.70 * dot(n, l) + 0.30, 0.0, 1.0);
        vec2 first = dot(along, h) - 0.09 + angles, second = dot(along, h) + 0.13 + angles;
        vec2 w = max(1.0 - first * first, 0.0), c = max(1.0 - second * second, 0.0);
        w *= w; w *= w; w *= w; w *= w; w *= w;   // to the power of 32
        c *= c; c *= c; c *= c;                   // of 8
        float body = sqrt(max(1.0 - t_l * t_l, 0.0)), through = max(-dot(view, l), 0.0);
        vec3 light = light_colour[i].rgb * facing * cover;
        total.body += light * base * body * (0.8 + gloss * 1.6 * through * through);
        // a highlight of the bare colour of a light looks blue on dark hair
        vec3 paler = 0.11 * gloss * mix(light, vec3(dot(light, vec3(0.3, 0.5, 0.2))), 0.6) * facing;
        vec3 own = 1.3 * gloss * base * light;
        total.shine += w.x * paler + c.x * own;
        total.other += w.y * paler + c.y * own;
    }
    return total;
}

vec3 hair_light(vec3 base, vec3 along, vec3 n, vec3 view, float gloss, float spread, float cover) {
    HairLight light = hair_lights(base, along, n, view, gloss, vec2(spread), cover);
    return light.body + light.shine;
}
