"""Requests and what came of them in the words of standards: pure functions from a run to documents, no network."""
