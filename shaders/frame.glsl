// What every program shares in one picture; written by agentface/view/gl/uniforms.py (std140).
const int LIGHTS = 4;

layout(std140) uniform Frame {
    mat4 view_projection;
    mat4 shadow_projection;  // from the key light
    mat4 head;               // turns the head, from the model's axes
    vec4 eye_point;          // the camera; w: height of the picture in pixels over the view's height at 1 m
    vec4 light_direction[LIGHTS];  // towards the light; the first is the key
    vec4 light_colour[LIGHTS];
    vec4 sky;
    vec4 ground;
};
