"""What agent kits call a face by."""
