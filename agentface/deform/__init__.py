"""From a pose to a face: vector muscles, lips, lids, jaw, normals."""
