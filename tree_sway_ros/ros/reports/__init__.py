"""
Diagnostics: what solver and wind node say of themselves.

Counts come from below, levels are decided here.
Nothing is logged from the hot path.

"""
