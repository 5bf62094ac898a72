"""What is true of any mesh: normals, finer and coarser meshes, splines, glTF."""
