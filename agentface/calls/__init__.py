"""What can be asked of a face from Python: one method for each kind of request."""
