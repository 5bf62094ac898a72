"""OpenGL: the context, programs, framebuffers, what all shaders share."""
