"""Gestures: short movements by name, made of key poses."""
