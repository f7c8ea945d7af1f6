"""Exceptions for invalid inputs and calls."""

from __future__ import annotations


class InputError(ValueError):
    """An input or a call is invalid; nothing was done.

    ``str(error)`` is the program's message, ``problem (why it is one) suggestion``.

    Attributes:
        problem: what is wrong, naming the offending file, key or value.
        why: why that is a problem; "" if the message has no such part.
        suggestion: what to do instead; "" if the message has no such part.
    """

    problem: str
    why: str
    suggestion: str

    def __init__(self, message: str, problem: str | None = None, why: str = "", suggestion: str = "") -> None:
        super().__init__(message)
        if problem is None:
            problem, why, suggestion = _parts(message)
        self.problem, self.why, self.suggestion = problem, why, suggestion


class ScriptError(InputError):
    """An experiment's script, journal or session is invalid.

    Attributes:
        file, line, column: place of the error; line and column count from 1, 0 = unknown.
    """

    file: str
    line: int
    column: int

    def __init__(
        self,
        message: str,
        problem: str | None = None,
        why: str = "",
        suggestion: str = "",
        file: str = "",
        line: int = 0,
        column: int = 0,
    ) -> None:
        super().__init__(message, problem, why, suggestion)
        self.file, self.line, self.column = file, line, column


def _parts(message: str) -> tuple[str, str, str]:
    """Splits "problem (why) suggestion"; why is the first balanced parenthesis after a space."""
    begin = message.find(" (")
    depth = 0
    for at in range(begin + 1, len(message)) if begin >= 0 else ():
        depth += {"(": 1, ")": -1}.get(message[at], 0)
        if depth == 0:
            return message[:begin], message[begin + 2 : at], message[at + 1 :].strip()
    return message, "", ""
