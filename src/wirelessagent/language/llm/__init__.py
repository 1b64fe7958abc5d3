"""Recognising sentences with an LLM: it chooses the meaning, and the rules hold it to what the sentence says.

The ``reader`` asks, through the ``client``, the LLM of the settings; ``prompt`` is what it is told, with the figures
that it may use, and the meaning that it fills in, which becomes an intent in ``check``.
"""
