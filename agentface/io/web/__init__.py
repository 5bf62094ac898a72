"""A face in a web page: what travels, who may ask, and the server."""
