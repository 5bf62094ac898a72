"""Files of performances: FAPs, action units, ARKit weights and poses, recognised by what is in them."""
