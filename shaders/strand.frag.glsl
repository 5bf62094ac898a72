#version 330 core
centroid in vec4 tone;
centroid in vec3 place;   // across -1..1, along 0..1, a number of its own
out vec4 colour;

uniform float streaks;    // how many finer hairs are drawn on each strand
uniform float solid;      // 1: hides what is behind it, 0: fades at its sides

void main() {
    float fine = abs(2.0 * fract(streaks * place.x + 0.6 * place.y + 7.0 * place.z) - 1.0);
    float across = place.x * place.x;
    colour = vec4(tone.rgb * (0.86 + 0.27 * fine), mix(tone.a * (1.0 - across * across), 1.0, solid));
}
