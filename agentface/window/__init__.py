"""The live window: what it shows, what keys and mouse do, its panel."""
