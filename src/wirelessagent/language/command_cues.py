"""Commands that change something are carried out only where a word of theirs is said and the model is sure."""

from __future__ import annotations

from wirelessagent.language.deferred import deferred

CHANGING = ("apply", "confirm", "undo", "reset")
_SURE_OF_A_COMMAND = 0.6
_CUES = {  # a command that changes something has one of these in it
    "reset": deferred(
        r"(?i)reset|clear|wip|eras|forget|delet|start over|again|scratch|afresh|anew|zero|new|fresh|slate|"
        r"square one|back|drop|scrap|"
        r"flush|beginning|defaults?|restart|top|重|清|忘|新|初始|零|默认|出厂|归|reinici|borr|cero|empe|olvid|"
        r"recommen|effac|zéro|réinit|"
        r"oubli|zurück|vorn|neu|lösch|vergiss|anfang"
    ),
    "undo": deferred(
        r"(?i)undo|rever|roll|back|restor|previous|before|cancel|retract|mistake|wrong|old|withdraw|oops|撤|回|退|"
        r"还原|恢复|取消|后悔|错|"
        r"deshac|deshaz|vuelve|revier|restaura|annul|retour|revien|défai|rückgängig|zurück|alten"
    ),
    "apply": deferred(
        r"(?i)appl|deploy|activ|implement|execut|roll|push|commit|install|enact|\buse\b|send|live|effect|operation|"
        r"happen|on air|"
        r"production|\bgo\b|proceed|do it|let's|carry|make it|engage|run with|ship|put it|write|load|take it|应用|"
        r"执行|下发|部署|生效|启用|实施|"
        r"落地|采用|提交|办|定|上线|开|推|动手|搞|走|就|用|按|照|做|发|adelante|hazlo|ponlo|aplíca|aplica|ejec|"
        r"despl|activa|vas-y|mets|exéc|"
        r"déplo|envoie|anwend|wende|übern|ausf|ausroll|spiel|mach|leg|setz|aktiv|damit"
    ),
}


def is_unsure(topic: str, plain: str, certainty: float) -> bool:
    """Whether a command that changes something may have been meant, and has to be asked for.

    >>> is_unsure("undo", "undo that", 0.9), is_unsure("undo", "hmm", 0.9), is_unsure("history", "hmm", 0.5)
    (False, True, False)
    """
    cue = _CUES.get(topic)
    said = cue is None or cue.search(plain) is not None
    return topic in CHANGING and not (said and certainty >= _SURE_OF_A_COMMAND)
