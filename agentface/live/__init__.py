"""The one loop in which a face runs, what it is told by, and where its frames go."""
