"""
The command line ``tree-sway``: one module per command.

Arguments in, text or a file out.
What a command computes lives lower.

"""
