"""The one loop in which a face runs."""
