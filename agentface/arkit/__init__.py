"""ARKit's face: its 52 shapes by name, and their weights over time as a phone has captured them."""
