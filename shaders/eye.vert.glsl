#version 330 core
#include "frame.glsl"
in vec3 place;     // in radii from the centre, the cornea at +Z
in vec3 facing;
uniform mat4 turned;   // from the eye's own axes and radii into the scene

centroid out vec3 position, local, local_normal;

void main() {
    vec4 placed = turned * vec4(place, 1.0);
    position = placed.xyz;
    local = place;
    local_normal = facing;
    gl_Position = view_projection * placed;
}
