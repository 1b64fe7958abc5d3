"""How the models of the offline recogniser are made: sentences, those drawn from templates, and the fits.

Nothing here is needed at run time; ``python -m wirelessagent.language.training`` writes ``language/sentences.npz``
anew.
"""
