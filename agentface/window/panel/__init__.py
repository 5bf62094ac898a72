"""The panel beside the face; needs imgui-bundle."""
