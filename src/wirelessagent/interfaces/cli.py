"""The command line: one command per operation, its options the fields of the request.

Errors are one line on stderr. Exit codes: 0 done, 1 failure, 2 bad input or a question back, 3 infeasible or undecided,
130 interrupted.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from typing import Any

import click
from pydantic import ValidationError

from wirelessagent.interfaces import cli_completion
from wirelessagent.interfaces.cli_chat import converse
from wirelessagent.interfaces.cli_commands import Commands
from wirelessagent.interfaces.cli_options import as_flag, is_positional
from wirelessagent.interfaces.cli_output import Listener, complain, exit_code, show, show_json, take_over, tell_page
from wirelessagent.operations.operation import AnyOperation, InputError, WirelessAgentError, installed_version, silent


def run(arguments: list[str]) -> int:
    """Run the command line and return its exit code."""
    take_over(notes="--json" not in arguments)
    program = _program()
    try:
        code = cli_completion.completed(program)
        if code is None:
            with program.make_context("wirelessagent", list(arguments)) as context:
                code = program.invoke(context)
        sys.stdout.flush()
    except click.exceptions.Exit as done:
        return done.exit_code
    except click.ClickException as error:
        return _fail(error.format_message(), 2)
    except InputError as error:
        return _fail(str(error), 2)
    except WirelessAgentError as error:
        return _fail(str(error), 1)
    except (KeyboardInterrupt, click.Abort):
        return _fail("interrupted", 130)
    except BrokenPipeError:  # whoever read our output has gone
        _give_up_output()
        return 1
    except OSError as error:
        _give_up_output()
        return _fail(f"{error.strerror or error}: {error.filename or 'the output'}", 1)
    except MemoryError:
        return _fail("not enough memory for this input", 1)
    except Exception as error:
        if os.environ.get("WIRELESSAGENT_DEBUG"):
            raise
        return _fail(
            f"internal error, please report it: {type(error).__name__}: {error} (WIRELESSAGENT_DEBUG=1 shows where)", 1
        )
    return code if isinstance(code, int) else 0


def _give_up_output() -> None:
    """Let what is still buffered go nowhere, so that the interpreter does not fail over it at its end."""
    sys.stdout = open(os.devnull, "w")  # noqa: PTH123, SIM115


def _fail(message: str, code: int) -> int:
    complain(message)
    return code


def _program() -> Commands:
    """All commands, and the options that the program has beside them."""
    options: list[click.Parameter] = [
        _eager(
            "--version", lambda program, value: f"wirelessagent {installed_version()}", "show the version", flag=True
        ),
        _eager("--show-completion", cli_completion.script, "print what completes commands in bash, zsh or fish"),
        _eager("--install-completion", cli_completion.install, "have your shell complete commands from now on"),
    ]
    return Commands("", _perform, options)


def _eager(name: str, said: Callable[[click.Command, str], str], text: str, *, flag: bool = False) -> click.Option:
    """An option that prints something in the place of all else."""

    def callback(ctx: click.Context, parameter: click.Parameter, value: str | bool | None) -> None:
        del parameter
        if value not in (None, False) and not ctx.resilient_parsing:
            tell_page(said(ctx.command, str(value)))
            ctx.exit()

    how: dict[str, Any] = {"is_flag": True} if flag else {"is_flag": False, "flag_value": "", "metavar": "[SHELL]"}
    return click.Option([name], is_eager=True, expose_value=False, callback=callback, help=text, **how)


def _perform(operation: AnyOperation, values: dict[str, Any], as_json: bool) -> int:
    request = _request(operation, values)
    if operation.converse is not None:
        return converse(operation, request, as_json=as_json)
    with Listener() as listener:
        record = operation.run(request, silent if as_json else listener)
    for fault in record.faults:
        complain(fault)
    if record.raw_lines is not None:
        for line in record.raw_lines:
            show_json(line)
    elif as_json:
        show_json(record.model_dump_json(indent=2))
    else:
        show(record, after_stages=listener.told)
    return exit_code(record)


def _request(operation: AnyOperation, values: dict[str, Any]) -> Any:
    try:
        return operation.request(**values)
    except ValidationError as error:
        first = error.errors()[0]
        field = str(first["loc"][0]) if first["loc"] else operation.name
        name = field if is_positional(operation.request, field) else as_flag(field)
        said = first["msg"].removeprefix("Value error, ").removeprefix("Input ")
        raise InputError(f"{name}: {said}; got {values.get(field, first['input'])!r}") from error
