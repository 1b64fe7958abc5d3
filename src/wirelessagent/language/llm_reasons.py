"""Why an LLM's answer is not used, in words for the operator, in English and Chinese."""

from __future__ import annotations

from collections.abc import Mapping

_NO_ANSWER: dict[str, tuple[str, str]] = {
    "late": ("no answer within {seconds:g} s", "{seconds:g} 秒内没有答复"),
    "status": ("HTTP {status}", "HTTP {status}"),
    "key": ("HTTP {status}, it refused the key", "HTTP {status}，密钥被拒绝"),
    "refused": ("it refused", "它拒绝回答"),
    "broken": ("the connection broke off", "连接中断"),
    "unreachable": ("it could not be reached", "无法连接"),
    "unreadable": ("what it sent could not be read", "返回内容无法读取"),
    "too_long": ("what it sent was too long", "返回内容过长"),
    "unusable": ("what it sent was no answer", "返回内容不是答复"),
}
_DID_NOT_HOLD: dict[str, tuple[str, str]] = {
    "no_objective": ("it named no objective", "没有给出目标"),
    "mixed": ("it mixed a request with something else", "把请求与其他内容混在一起"),
    "no_request": ("it changed a request that there is not", "修改了并不存在的请求"),
    "not_quoted": ("it quoted no words for the objective", "没有引用表示目标的原话"),
    "misquoted": ("it quoted words that were not said", "引用了没有说过的话"),
    "twice": ("it gave one thing twice", "同一项给出了两次"),
    "cells_own": ("it gave users what only the cell has", "把小区的限制给了用户"),
    "impossible": ("it gave an impossible figure", "给出了不可能的数值"),
    "invented": ("it gave a figure that was not said", "给出了没有说过的数值"),
    "turned": ("it turned a bound round", "把上下限弄反了"),
    "no_user": ("it named a user who was not named", "提到了没有说过的用户"),
    "crossed": ("it gave rates that cannot both hold", "给出了不能同时成立的速率"),
    "left_out": ("it left out a figure", "漏掉了一个数值"),
    "passed_over": ("it passed over a figure that cannot be used", "忽略了一个无法使用的数值"),
    "otherwise": ("it read a figure otherwise than the rules", "对数值的理解与规则不同"),
    "doubtful": ("the rules are in doubt about a figure", "规则对一个数值有疑问"),
    "asked_nothing": ("it said nothing", "没有说出内容"),
    "not_asked": ("it took something else for a request", "把别的话当成了请求"),
    "refused_wish": ("it took a refusal for a request", "把拒绝当成了请求"),
    "not_tied": ("it read a wish into words that do not hold it", "从原话中读出了没有的愿望"),
    "let_go": ("it let go of limits that were not taken back", "去掉了没有取消的限制"),
    "pretended": ("it did not only ask", "它说的不只是问题"),
    "go_ahead": ("it took a sentence for a go-ahead", "把一句话当成了执行的许可"),
}
_NOT_ASKED: dict[str, tuple[str, str]] = {
    "unsendable": ("the sentence holds a character that cannot be sent", "句中有无法发送的字符"),
    "unsent": ("the request could not be made", "请求无法发出"),
}
_FRAMES = {
    "en": ("the LLM did not answer: {}", "the LLM's answer did not hold: {}", "nothing was sent to the LLM: {}"),
    "zh": ("大模型没有作答：{}", "大模型的答案不成立：{}", "没有向大模型发送任何内容：{}"),
}
_NOTES = {"en": "(Read by the offline recogniser; {}.)", "zh": "（由离线识别器理解；{}。）"}


class Objection(Exception):
    """Why a meaning cannot be so: ``reason`` for the LLM, and the ``key`` of what the operator is told."""

    def __init__(self, key: str, reason: str) -> None:
        super().__init__(reason)
        self.key, self.reason = key, reason


def told(key: str, language: str, names: Mapping[str, float]) -> str:
    """A reason as one clause, such as "the LLM did not answer: HTTP 500"."""
    language = language if language in _FRAMES else "en"
    kinds = zip(_FRAMES[language], (_NO_ANSWER, _DID_NOT_HOLD, _NOT_ASKED), strict=True)
    frame, reasons = next((frame, reasons) for frame, reasons in kinds if key in reasons)
    return frame.format(reasons[key][language == "zh"].format(**names))


def note(clause: str, language: str) -> str:
    """The sentence that tells the operator who read theirs."""
    return _NOTES.get(language, _NOTES["en"]).format(clause)
