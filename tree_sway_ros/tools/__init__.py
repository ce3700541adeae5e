"""The command line tree-sway."""
