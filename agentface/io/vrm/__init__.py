"""VRM 1.0 avatars of a face."""
