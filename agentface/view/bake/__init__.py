"""Colours that shaders make, as pictures and meshes for other programs to draw."""
