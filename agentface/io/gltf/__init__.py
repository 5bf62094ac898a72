"""glTF files of a face: its meshes, materials and shapes, and what it does over time."""
