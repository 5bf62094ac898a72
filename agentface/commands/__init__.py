"""The commands of the command line, one a module; what is heavy they import when they run."""
