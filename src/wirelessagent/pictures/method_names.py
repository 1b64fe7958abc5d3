"""What methods are called where people look: in the legends and labels of pictures."""

from __future__ import annotations

_NAMES = {
    "perfect": "perfect CSI",
    "user_mean": "mean filling",
    "nncf_paper": "NNCF as printed",
    "nncf": "NNCF with relative gains",
    "linear": "linear interpolation",
    "cubic": "cubic spline",
    "knn": "nearest neighbours",
    "iterative": "iterative regression",
    "soft_impute": "SoftImpute",
    "avoid_repaired": "only what was observed",
    "paper": "the paper's method",
    "paper_bisection": "the paper's bisection",
    "paper_inversion": "the paper's inversion",
    "paper_scan": "the paper's power scan",
}


def readable(name: object) -> str:
    """A plug-in's name in words; that of somebody else's plug-in without its underscores.

    >>> readable("nncf_paper"), readable("my_repairer")
    ('NNCF as printed', 'my repairer')
    """
    return _NAMES.get(str(name), str(name).replace("_", " "))
