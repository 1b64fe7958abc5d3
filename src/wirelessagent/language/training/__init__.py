"""How the linear model of the offline recogniser is made: templates, sentences drawn from them, and the fit.

Nothing here is needed at run time; ``python -m wirelessagent.language.training`` writes ``language/model.npz`` anew.
"""
