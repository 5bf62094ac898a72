"""A face as tools for language models: the Model Context Protocol (modelcontextprotocol.io)."""
