"""The head: its mesh, regions, landmarks and muscles, and the module that makes the faces."""
