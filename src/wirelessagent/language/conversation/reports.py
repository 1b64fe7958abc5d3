"""Statements of what was, or of what somebody else says, which ask for nothing: "yesterday we had 15 W"."""

from __future__ import annotations

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred

_PAST = deferred(
    r"\b(?:yesterday|last\s+(?:week|month|night|year|time)|previously|formerly|ago|used\s+to|in\s+the\s+past)\b|"
    r"\b(?:we|they|it|users?|@|i|everyone|the\s+cell)\s+(?:had|was|were|got|ran|used)\b|"
    r"昨天|昨晚|前天|上周|上个?月|去年|以前|曾经|过去|(?:之前|原来|上次|刚才)(?:我们)?(?:是|有|用|只)"
)
_REPORTED = deferred(
    r"\b(?:complain(?:s|ed|ing)?|report(?:s|ed)|says?|said|told|tells|claims?|claimed)\b|投诉|抱怨|反映|反馈|诉苦|(?:号|用户|@)说"
)
_HAS = deferred(r"\b(?:has|have|had|gets?|got|is|was|only)\b|只有|才|仅|是|有|不到")
_DIRECTS = deferred(
    r"\b(?:want|wants|need|needs|should|must|let|please|make|set|give|raise|now|do|use|keep|limit|go|so|again|instead)\b|"
    r"\bat\s+(?:least|most)\b|要|需|应|请|改|把|给|保证|提高|让|设|现在|今天|至少|最多|不超过|希望|想|恢复|回到|一样|照"
)


def is_report(line: Line) -> bool:
    """Whether a line only states what was or what somebody says, with no word that asks for anything."""
    said = line.shape
    past = _PAST.search(said) is not None
    return (past or (bool(_REPORTED.search(said)) and bool(_HAS.search(said)))) and not _DIRECTS.search(said)
