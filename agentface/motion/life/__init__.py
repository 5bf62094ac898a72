"""What keeps a face alive between messages: when it blinks, where it glances, how it sways and breathes."""
