"""Methods for one key segment, side by side: one file a method."""
