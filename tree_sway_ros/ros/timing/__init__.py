"""
When to step and when to send: the pacer, uneven steps, playback of records.

Time is integer nanoseconds.
What is sent is made in ``wire``.

"""
