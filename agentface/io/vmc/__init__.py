"""The Virtual Motion Capture protocol: faces drive avatars, and trackers drive faces, over OSC."""
