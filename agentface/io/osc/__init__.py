"""Open Sound Control: emotion messages over UDP (Wright and Freed, ICMC 1997; specification 1.0)."""
