"""Slow and plain models that the reduced tree is measured against."""
