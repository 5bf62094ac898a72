"""Lips, jaw, teeth: orbicularis oris, the lips' surface, contact."""
