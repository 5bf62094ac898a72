"""The ways in and out: files, videos, network protocols."""
