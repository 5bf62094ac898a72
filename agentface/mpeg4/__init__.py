"""MPEG-4's face: feature points, FAPs read off a geometry, and the pose that shows given FAPs (ISO/IEC 14496-2)."""
