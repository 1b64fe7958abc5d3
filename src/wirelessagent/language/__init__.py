"""From an operator's words to a typed request: quantities, recognisers and replies.

The layers, mostly each on those before it: ``word_tables``, ``text``, ``vocabulary`` (words, mistyped ones too) →
``number_words``, ``units``, ``numerals`` (digits, number words, multiples) → ``comparators`` (at least, at most) →
``mentions`` (who is spoken of) and ``quantities`` (all of these, the only source of figures) → ``stated`` (what is read
so far, what is said of the whole cell, and numbers that nobody reads) → ``figure_roles``, ``number_roles``, ``judged``
(what each number, figure and user is there for, and the words that say so, by a small model) → ``constraints`` (which
field a figure means, and who gets it) and ``goals`` (which objective the words mean) → ``order_model``,
``sentence_model`` (two readers of the whole: an order or not, of what kind, and whether it was read as it is meant) →
``sentence`` (all of that, once) → ``topics`` (what is asked) → ``offline`` (the recogniser) → ``guard`` (behind every
recogniser) → ``conversation`` (a line where it stands).

``figures`` holds the words beside figures and users, ``moods`` those of refusals, reports and the like, and ``lexicon``
those of wishes, as data; ``training`` makes the models.
"""
