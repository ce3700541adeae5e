"""
Speed against accuracy as pictures and tables.

One file per chart.
The numbers come from benches and references.

"""
