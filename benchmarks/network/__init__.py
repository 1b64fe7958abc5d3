"""A small network that judges sentences: what it sees, how it is taught (``bars_network.py``)."""
