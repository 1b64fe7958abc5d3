"""Recognising sentences with an LLM: it chooses the meaning, and the rules hold it to what the sentence says.

The ``reader`` asks, through the ``client``, the LLM at the ``endpoint``; ``prompt`` is what it is told, with the
figures that it may use, and the ``meaning`` that it fills in becomes an intent in ``check``.
"""
