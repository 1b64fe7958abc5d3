"""From an operator's words to a typed request: quantities, recognisers and replies.

The layers, each knowing only those before it: ``text``, ``spelling`` (the same length) → ``numerals`` (digits and
number words) → ``units`` → ``comparators`` (at least, at most) → ``quantities`` (all of these, the only source of
figures) → ``mentions`` (who is spoken of), ``roles`` (left out, served alone), ``allotments`` (who gets which
figure), ``surroundings`` and ``figure_words`` (what words beside a figure make of it) → ``constraints`` (which field
a figure means), ``leftovers`` (the figures that nothing read) and ``vocabulary``, ``goals`` (which objective the
words mean) → ``sentence`` (all of that, once) → ``features``, ``linear_model``, ``forms`` → ``judgement`` (what the
sentence wants) → ``topics``, ``followups`` (details, changes of a request) → ``offline`` (the recogniser).
``lexicon`` holds the words and ``replies`` the sentences, as data; ``training`` makes the model.
"""
