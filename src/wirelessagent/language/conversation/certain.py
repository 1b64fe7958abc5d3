"""Whether a command that changes something is all that a line says; where it is not, the operator is asked.

The offline recogniser hears "undo" in "the people in the back can't hear us" and in "I didn't say undo". So what it
takes for apply, undo or start over is carried out only where every word of the line belongs to such a command.
"""

from __future__ import annotations

from wirelessagent.language import forms
from wirelessagent.language.conversation.command_words import CHINESE, WORDS
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Intent
from wirelessagent.language.offline import NAME
from wirelessagent.language.text import normalise

_CHANGING = ("apply", "undo", "reset")
_LONGEST = 120
"""Characters of a line that may be nothing but a command."""

_ZH_WORD = deferred("|".join(CHINESE))
_ZH_DENIED = deferred("如果|要是|假如|吗|要不要|该不该|能不能|可不可以|没|别|不(?:是|要|用|想|该|能|会|准|许|再)|未")
_LATIN = deferred(r"[a-zß-ÿœ](?:[a-zß-ÿœ'’-]*[a-zß-ÿœ])?")
_LETTER = deferred(r"[^\W_]")
_NAMED = deferred(
    r"(?i)\b(?:undo\w*|revert\w*|roll\w*\s?back|retract|withdraw|reverse|restore|previous|mistake|oops|reset|restart|"
    r"forget|erase|wipe|clear|start(?:ing)?\s+(?:over|afresh|again|anew)|scratch|apply|activate|deploy|implement|execute|"
    r"enact|roll\w*\s+\w*\s*out|go\s+(?:ahead|live)|proceed|"
    r"(?:take|put|go|get|bring|step|switch|change|turn|set)\s+(?:\w+\s+){0,2}back)\b|"
    r"撤|退|回滚|还原|恢复|收回|取消|重置|重来|重新|从头|清空|清除|清零|归零|复位|忘|应用|执行|下发|部署|生效|启用|上线|激活"
)
"""Words that speak of such a command, whatever else a line says."""
_POLITE = deferred(
    r"^(?:(?:oh|ah|well|ok(?:ay)?)[,\s]+)?(?:no|nein|non)\s*[,，.;!]\s*|\b(?:could|can|would|will)\s+you(?:\s+mind)?\b|\bnever\s*mind\b|"
    r"^(?:could|can)\s+(?:we|i)\b|\bgo\s+ahead\b|能不能帮我|可不可以帮我|能帮我"
)


def made_certain(line: Line, intent: Intent, text: str) -> Intent:
    """The command where a line is nothing else or it changes nothing, a question of yes or no in its place otherwise.

    ``text`` is all that was said; a line may be the beginning of it.
    """
    if not intent.recogniser.startswith(NAME):
        return intent
    if intent.kind == "command" and intent.topic in _CHANGING and not is_only_a_command(text):
        return line.ask("what_changes") if _names_none(line, text) else line.ask_whether(intent.topic)
    return line.ask("what_changes") if intent.offered in _CHANGING and _names_none(line, text) else intent


def _names_none(line: Line, text: str) -> bool:
    """Whether a line about a request that holds has no word that stands for a command alone."""
    return line.context.objective is not None and _NAMED.search(normalise(text)) is None


def is_only_a_command(text: str) -> bool:
    """Whether every word of a line belongs to a command, and none denies it, supposes it or asks about it.

    >>> is_only_a_command("oh no, please take that back"), is_only_a_command("he's back")
    (True, False)
    """
    plain = normalise(text).lower().strip()
    if len(plain) > _LONGEST:
        return False
    said = _POLITE.sub(" ", plain)
    if said == plain and (plain.endswith("?") or forms.begins_like_a_question(plain)):
        return False
    if _ZH_DENIED.search(said):
        return False
    words = _LATIN.findall(said)
    if any(word.replace("’", "'") not in WORDS for word in words):
        return False
    return not _LETTER.search(_ZH_WORD.sub("", _LATIN.sub("", said)))
