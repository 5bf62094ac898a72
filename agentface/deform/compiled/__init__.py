"""The compiled loops of a frame; importing one of these modules loads numba, which takes half a second."""
