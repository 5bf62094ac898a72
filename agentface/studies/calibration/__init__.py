"""Fits a face's vector muscles to the artists' shapes of the same mesh, and measures how well they agree."""
