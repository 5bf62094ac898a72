"""How the face moves between one state and the next: envelopes, channels and their mixer."""
