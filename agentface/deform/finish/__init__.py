"""What the skin of every deformer gets last: wrinkles, normals, neck, the head's turn."""
