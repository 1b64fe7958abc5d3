"""From an operator's words to a typed request: quantities, recognisers and replies.

The layers, mostly each on those before it: ``text``, ``vocabulary`` (words, mistyped ones too) → ``number_words``,
``units``, ``numerals`` (digits, number words, multiples) → ``comparators`` (at least, at most) → ``quantities`` (all of
these, the only source of figures) → ``mentions`` (who is spoken of) and ``leftovers`` (the other numbers) → ``stated``
(what is read so far, and what is said of the whole cell) → ``role_features``, ``figure_roles``, ``looks``, ``judged``
(what each figure and user is there for, and the words that say so, by a small model) → ``allotments`` (who gets which
figure) → ``constraints`` (which field a figure means) and ``goals`` (which objective the words mean) → ``order_model``,
``sentence_model`` (two readers of the whole: an order or not, of what kind, and whether it was read as it is meant) →
``sentence`` (all of that, once) → ``forms`` → ``judgement`` (what the sentence wants) → ``topics`` (details) →
``offline`` (the recogniser).
``figures`` holds the words beside figures and users, ``lexicon`` those of wishes and ``replies`` the sentences, as
data; ``training`` makes the models.
"""
