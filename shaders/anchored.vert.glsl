#version 330 core
// Something that rides on the skin: the mean move of four skin vertices, plus a fixed offset.
#include "frame.glsl"
#include "surface.glsl"
in ivec4 anchors;
in vec3 offset;        // from the anchors' mean, metres
in vec3 facing;
in vec3 rest;
in vec4 material;

centroid out vec3 normal, rest_position;
centroid out vec4 matter;

void main() {
    vec3 mean = 0.25 * (skin_position(anchors.x) + skin_position(anchors.y) + skin_position(anchors.z) + skin_position(anchors.w));
    vec4 placed = head * vec4(mean + offset, 1.0);
    normal = mat3(head) * facing;
    rest_position = rest;
    matter = material;
    gl_Position = view_projection * placed;
}
