"""
No more model than a scene needs: error and cost of every model, and the choice among them.

Estimates are made before a step is taken.
The models themselves live lower.

"""
