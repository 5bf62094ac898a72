"""The face in a web page: the server, what it sends, and the page."""
