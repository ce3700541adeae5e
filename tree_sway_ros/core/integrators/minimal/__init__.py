"""Methods on the angles: the paper's equation with its multipliers eliminated."""
