"""The stability battery: one case a file, each a function that returns rows of what held."""
