"""Who may do what: tokens with a role, and the browser sessions that a token opens. Only their hashes are kept."""

from __future__ import annotations

import hashlib
import hmac
import secrets
import time
from dataclasses import dataclass
from typing import Literal, TypeAlias, cast, get_args

from wirelessagent.service.problems import NotSignedInError
from wirelessagent.store.ledger import Item, Ledger

Role: TypeAlias = Literal["viewer", "operator"]
"""A viewer sees everything and changes nothing."""

ROLES: tuple[Role, ...] = get_args(Role)

SIGNED_IN_S = 12 * 3600
"""How long a browser stays signed in."""

_TOKEN, _SIGNED_IN = "token", "signed_in"


@dataclass(frozen=True)
class Caller:
    """Who asks.

    Attributes:
        name: of the token; "local" where none is needed.
        role: what they may do.
    """

    name: str
    role: Role

    @property
    def may_change(self) -> bool:
        return self.role == "operator"


LOCAL = Caller("local", "operator")
"""Whoever reaches a server that only this machine reaches, and that has no tokens."""


class Access:
    """The tokens in a ledger."""

    def __init__(self, ledger: Ledger) -> None:
        self._ledger = ledger

    def grant(self, name: str, role: Role) -> str:
        """A new token for a name, in the place of one that it had; only its hash is kept."""
        self.revoke(name)
        token = f"wa_{secrets.token_urlsafe(32)}"
        self._ledger.put(_TOKEN, _hash(token), {"name": name, "role": role}, seen=0)
        return token

    def revoke(self, name: str) -> bool:
        """Take the token of a name back, with the browser sessions that it opened; whether it had one."""
        found = [item for item in self._ledger.all(_TOKEN) if item.data["name"] == name]
        for item in found:
            self._ledger.drop(_TOKEN, item.id)
        return bool(found)

    @property
    def callers(self) -> list[Caller]:
        """Who has a token."""
        return [_caller(item) for item in self._ledger.all(_TOKEN)]

    def by_token(self, token: str) -> Caller:
        """Who a token belongs to.

        Raises:
            NotSignedInError: nobody.
        """
        return _caller(self._found(_TOKEN, token, "this token is not known: ask whoever runs the server for one"))

    def by_cookie(self, cookie: str) -> Caller:
        """Who a browser session belongs to.

        Raises:
            NotSignedInError: nobody, or it is over.
        """
        otherwise = "this session is over: sign in again"
        held = self._found(_SIGNED_IN, cookie, otherwise).data
        token = None if held["until"] < time.time() else self._ledger.find(_TOKEN, held.get("token", ""))
        if token is None:
            raise NotSignedInError(otherwise)
        return _caller(token)

    def sign_in(self, token: str) -> tuple[Caller, str]:
        """A new browser session for a token, as the value of its cookie; sessions that are over are swept away."""
        caller, cookie, now = self.by_token(token), secrets.token_urlsafe(32), time.time()
        for item in self._ledger.all(_SIGNED_IN):
            if item.data["until"] < now:
                self._ledger.drop(_SIGNED_IN, item.id)
        kept = {"token": _hash(token), "until": now + SIGNED_IN_S}
        self._ledger.put(_SIGNED_IN, _hash(cookie), kept, seen=0)
        return caller, cookie

    def sign_out(self, cookie: str) -> None:
        """End a browser session."""
        self._ledger.drop(_SIGNED_IN, _hash(cookie))

    def _found(self, kind: str, secret: str, otherwise: str) -> Item:
        item = self._ledger.find(kind, _hash(secret))
        if item is None or not hmac.compare_digest(item.id, _hash(secret)):
            raise NotSignedInError(otherwise)
        return item


def _caller(token: Item) -> Caller:
    """Who a token belongs to."""
    return Caller(token.data["name"], cast("Role", token.data["role"]))


def _hash(secret: str) -> str:
    """Tokens and cookies are long random texts, so a plain hash hides them."""
    return hashlib.sha256(secret.encode("utf-8", "surrogateescape")).hexdigest()
