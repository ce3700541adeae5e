"""
Processes: start, spin and end a node; several nodes in one process; topics and their QoS.

Nothing raised in a callback ends an executor.
What a node does is written in ``nodes``.

"""
