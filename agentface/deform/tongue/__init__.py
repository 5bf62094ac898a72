"""The tongue: what moves it, and the way out of the mouth that teeth and lips leave to it."""
