"""Faces in the terms of VRM avatars: their expressions, and the turns of their bones."""
