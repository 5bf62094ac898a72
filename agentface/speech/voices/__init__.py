"""Voices: programs and libraries of the machine that speak a sentence and say when each phone of it is heard."""
