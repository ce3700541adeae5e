"""
The laboratory: methods side by side, battery, benches, charts, comparisons.

Reached by ``tree-sway battery|chart|compare|bench``.
Nothing that runs imports it.

"""
