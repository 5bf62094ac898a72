"""Pictures: OpenGL through moderngl."""
