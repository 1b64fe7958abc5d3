"""From an operator's words to a typed request: quantities, recognisers and replies.

The layers, each knowing only those before it: ``text``, ``spelling`` (the same length) → ``numerals`` (digits and
number words) → ``unit_slips``, ``units`` → ``comparators`` (at least, at most) → ``quantities`` (all of these, the
only source of figures) → ``mentions`` (who is spoken of), ``nines``, ``factors`` and ``leftovers`` (the other
numbers), ``roles``, ``surroundings`` and ``figure_words`` (what words beside a user or a figure make of it) →
``role_features``, ``figure_roles``, ``judged`` (what each is there for, by a small model) → ``exceptions`` (who is kept
or excepted), ``allotments`` (who gets which figure) → ``constraints`` (which field a figure means) and ``vocabulary``,
``goals`` (which objective the words mean) → ``sentence`` (all of that, once) → ``features``, ``linear_model``,
``forms`` → ``judgement`` (what the sentence wants) → ``topics``, ``followups`` (details, changes of a request),
``nobody_starves`` (a wish beside the wish) → ``offline`` (the recogniser).
``lexicon`` holds the words and ``replies`` the sentences, as data; ``training`` makes the models.
"""
