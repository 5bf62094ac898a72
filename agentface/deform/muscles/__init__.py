"""The vector muscles and what bounds them: they move the skin before lips, lids and jaw do."""
