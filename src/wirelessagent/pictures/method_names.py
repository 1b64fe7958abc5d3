"""What methods are called where people look: in the legends and labels of pictures."""

from __future__ import annotations

from wirelessagent.telling.catalogue import has_message, message


def readable(name: object, language: str = "en") -> str:
    """A plug-in's name in words; that of somebody else's plug-in without its underscores.

    >>> readable("nncf_paper"), readable("my_repairer")
    ('NNCF as printed', 'my repairer')
    """
    key = f"legend.{name}"
    return message(language, key) if has_message(language, key) else str(name).replace("_", " ")
