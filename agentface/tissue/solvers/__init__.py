"""How the tissue gets from a load to a shape: the paper's two ways, and the default."""
