"""What can go wrong with a request to the service, as problems in the sense of RFC 9457."""

from __future__ import annotations

import logging
from typing import Any

from wirelessagent.operations.operation import InputError, WirelessAgentError

_log = logging.getLogger("wirelessagent.service")


class ProblemError(Exception):
    """A request that cannot be answered as it was meant; ``detail`` says what was wrong and what to do.

    Attributes:
        status: of HTTP.
        title: the kind of problem.
        headers: what the answer says beside.
    """

    status = 400
    title = "This cannot be done"

    def __init__(self, detail: str, *, status: int | None = None, title: str | None = None, **headers: str) -> None:
        super().__init__(detail)
        self.detail, self.headers = detail, {name.replace("_", "-"): value for name, value in headers.items()}
        self.status, self.title = status or type(self).status, title or type(self).title

    @property
    def body(self) -> dict[str, Any]:
        """The problem as JSON."""
        return {"type": "about:blank", "title": self.title, "status": self.status, "detail": self.detail}


class NotFoundError(ProblemError):
    """There is no such thing."""

    status, title = 404, "There is no such thing"


class ConflictError(ProblemError):
    """Things are not as the caller has seen them."""

    status, title = 409, "Things have changed"


class NotSignedInError(ProblemError):
    """The caller has to say who they are."""

    status, title = 401, "Sign in first"

    def __init__(
        self, detail: str = "say who you are by a token: Authorization: Bearer …, or sign in at /sign-in"
    ) -> None:
        super().__init__(detail, WWW_Authenticate='Bearer realm="wirelessagent"')


class ForbiddenError(ProblemError):
    """The caller may not do this."""

    status, title = 403, "This is not allowed"


class TooMuchError(ProblemError):
    """The caller asks too often or for too much."""

    status, title = 429, "Too many requests"


class TooLargeError(ProblemError):
    """What was sent is larger than allowed."""

    status, title = 413, "Too large"


class UnusableError(ProblemError):
    """What was sent cannot be used."""

    status, title = 422, "This cannot be used"


class BrokeOffError(ProblemError):
    """The process that did the work is gone."""

    status, title = 500, "The work broke off"

    def __init__(
        self, detail: str = "the work ended its process, as too large an input does; nothing else was lost"
    ) -> None:
        super().__init__(detail)


class UnavailableError(ProblemError):
    """What is needed is not there for now; the caller may try again."""

    status, title = 503, "This cannot be done just now"


class TimedOutError(ProblemError):
    """The work took longer than it may."""

    status, title = 504, "This took too long"


def problem_of(error: Exception) -> ProblemError:
    """Whatever went wrong in the server itself as a problem; where it is no fault of the caller's, its log says what.

    What workers say of their failures they say themselves (:mod:`wirelessagent.service.worker`).
    """
    if isinstance(error, ProblemError):
        return error
    if isinstance(error, InputError):
        return UnusableError(str(error))
    _log.error("a request failed", exc_info=error)
    if isinstance(error, WirelessAgentError):
        return UnavailableError("what this server keeps cannot be read or written just now; its log says more")
    return ProblemError("the server's log says more", status=500, title="Internal error")
