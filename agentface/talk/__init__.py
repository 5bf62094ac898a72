"""A face that says a text: sentences are spoken in the background, and shown and heard in their time."""
