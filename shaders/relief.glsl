// What bytes of the wrinkle atlas stand for, -1..1.
vec4 relief(vec4 texel) {
    return (255.0 * texel - 128.0) / 127.0;
}
