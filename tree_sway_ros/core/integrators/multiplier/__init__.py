"""Methods on the paper's coordinates: X, Y, theta of each segment, held together by multipliers."""
