"""BML documents."""
