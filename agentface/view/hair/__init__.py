"""Hair: where it grows, how it is groomed, how it is drawn."""
