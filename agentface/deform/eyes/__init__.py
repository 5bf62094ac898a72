"""Lids and eyeballs."""
