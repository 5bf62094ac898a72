"""What a program is told of a face, and how it waits for it."""
