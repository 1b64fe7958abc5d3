"""The audit store: every turn as it was, for good.

:class:`.store.Store` appends and reads, :mod:`.replay` does a turn's work again. SQLAlchemy is loaded with the first of
them and nowhere else.
"""
