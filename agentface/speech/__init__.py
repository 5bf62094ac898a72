"""From timed phones to what the mouth does: visemes, alphabets, coarticulation."""
