"""Pictures and the live window: OpenGL through moderngl."""
