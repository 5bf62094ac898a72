"""The skin in pictures, with fine lips, wrinkles and the shirt."""
