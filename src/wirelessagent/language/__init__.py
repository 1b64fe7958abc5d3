"""From an operator's words to a typed request: quantities, recognisers and replies.

The layers, each knowing only those before it: ``text``, ``spelling`` (the same length) → ``number_words``, ``units``,
``numerals`` (digits, number words, multiples) → ``comparators`` (at least, at most) → ``quantities`` (all of these, the
only source of figures) → ``mentions`` (who is spoken of), ``ratios`` and ``leftovers`` (the other numbers) →
``role_features``, ``figure_roles``, ``looks``, ``judged`` (what each figure and user is there for, and the words that
say so, by a small model) → ``allotments`` (who gets which figure), ``whole_cell`` → ``constraints`` (which field a
figure means) and ``vocabulary``, ``goals`` (which objective the words mean) → ``order_model``, ``sentence_model`` (two
readers of the whole: an order or not, of what kind, and whether it was read as it is meant) → ``sentence`` (all of
that, once) → ``forms`` → ``judgement`` (what the sentence wants) → ``topics``, ``followups``
(details, changes of a request) → ``offline`` (the recogniser).
``figures`` holds the words beside figures and users, ``lexicon`` those of wishes and ``replies`` the sentences, as
data; ``training`` makes the models.
"""
