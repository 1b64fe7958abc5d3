"""From an operator's words to a typed request: quantities, recognisers and replies.

The layers, each knowing only those before it: ``text`` (spelling, same length) → ``numerals`` (digits and number words)
→ ``units`` → ``comparators`` (at least, at most) → ``quantities`` (all of these, the only source of figures) →
``surroundings`` (what words beside a figure make of it) → ``constraints`` (which field a figure means), ``leftovers``
(the figures that nothing read) and ``vocabulary``, ``goals`` (which objective the words mean) →
``offline`` (the recogniser). ``lexicon`` holds the words and ``replies`` the sentences, as data.
"""
