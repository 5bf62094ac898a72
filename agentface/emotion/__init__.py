"""From an emotion message to muscle contractions, by fuzzy rules, and why.

Import from the modules: ``state``, ``rules``, ``inference``; only running an inference loads numba.
"""
