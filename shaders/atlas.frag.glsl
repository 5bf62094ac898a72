#version 330 core
in vec2 share;
flat in int number;
out vec4 found;

void main() {
    found = vec4(share, float(number), 1.0);
}
