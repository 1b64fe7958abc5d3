"""The command line: one command per operation, its options the fields of the request.

Errors are one line on stderr. Exit codes: 0 done, 1 failure, 2 bad input or a question back, 3 infeasible or undecided,
130 interrupted.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from typing import Annotated, Any

import typer
from pydantic import ValidationError

from wirelessagent.interfaces.cli_chat import converse
from wirelessagent.interfaces.cli_options import Parameters, as_flag, is_positional
from wirelessagent.interfaces.cli_output import Listener, complain, exit_code, show, show_json, take_over, tell
from wirelessagent.operations.catalogue import GROUPS, OPERATIONS
from wirelessagent.operations.operation import AnyOperation, InputError, WirelessAgentError, installed_version, silent

_EPILOG = (
    "Errors go to stderr. Exit codes: 0 done, 1 failure, 2 bad input or a question back, 3 infeasible or undecided, "
    "130 interrupted."
)


def run(arguments: list[str]) -> int:
    """Run the command line and return its exit code."""
    take_over(notes="--json" not in arguments)
    if not {"-h", "--help"}.isdisjoint(arguments):
        _show_long_names_whole()
    command = typer.main.get_command(_app(arguments))
    try:
        code = command.main(args=arguments, prog_name="wirelessagent", standalone_mode=False)
        sys.stdout.flush()
    except typer.TyperException as error:  # without a message the help was shown: no command was named
        return _fail(error.format_message(), 2) if error.format_message() else 2
    except InputError as error:
        return _fail(str(error), 2)
    except WirelessAgentError as error:
        return _fail(str(error), 1)
    except (KeyboardInterrupt, typer.Abort):
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


def _show_long_names_whole() -> None:
    """Have option names that are too long for their column go on in the next line; Typer cuts them off."""
    from rich.text import Text
    from typer import rich_utils

    class Folding(type(rich_utils.highlighter)):
        def __call__(self, text: str | Text) -> Text:
            found = super().__call__(text)
            found.overflow = "fold"
            return found

    rich_utils.highlighter = Folding()


def _app(arguments: list[str]) -> typer.Typer:
    """The application. Only the command in use gets its parameters: looking up every plug-in's options takes time."""
    app = typer.Typer(
        name="wirelessagent",
        no_args_is_help=True,
        add_completion=False,
        rich_markup_mode="rich",
        epilog=_EPILOG,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(help="From an operator's words to a certified OFDMA allocation.")(_root)
    words = [word for word in arguments if not word.startswith("-")]
    alone = {operation.name for operation in OPERATIONS} & GROUPS.keys()
    groups = {name: typer.Typer(no_args_is_help=name not in alone, rich_markup_mode="rich") for name in GROUPS}
    paths = [operation.name.split() for operation in OPERATIONS]
    asked = max((path for path in paths if words[: len(path)] == path), key=len, default=list[str]())
    for operation, path in zip(OPERATIONS, paths, strict=True):
        command = _command(operation, Parameters(operation.request) if path == asked else None)
        if operation.name not in alone:
            owner = groups[path[0]] if len(path) > 1 else app
            owner.command(name=path[-1], help=operation.summary + ".", epilog=_EPILOG)(command)
        elif path == asked:  # else a second word follows, whose command it is
            groups[path[0]].callback(invoke_without_command=True)(command)
    for name, group in groups.items():
        app.add_typer(group, name=name, help=GROUPS[name] + ".", epilog=_EPILOG)
    return app


def _version(asked: bool) -> None:
    if asked:
        tell(f"wirelessagent {installed_version()}")
        raise typer.Exit


def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    del version


def _command(operation: AnyOperation, parameters: Parameters | None) -> Callable[..., int]:
    def command(**values: Any) -> int:
        assert parameters is not None  # a command that runs is the one that was asked for
        as_json = values.pop("json")
        request = _request(operation, parameters.values(values))
        if operation.converse is not None:
            return converse(operation, request, as_json=as_json)
        with Listener() as listener:
            record = operation.run(request, silent if as_json else listener)
        for fault in record.faults:
            complain(fault)
        if record.lines is not None:
            for line in record.lines:
                show_json(line)
        elif as_json:
            show_json(record.model_dump_json(indent=2))
        else:
            show(record)
        return exit_code(record)

    if parameters is not None:
        command.__signature__ = parameters.signature()  # type: ignore[attr-defined]
        command.__annotations__ = parameters.annotations()
    else:
        command.__signature__ = Parameters.empty()  # type: ignore[attr-defined]
        command.__annotations__ = {}
    return command


def _request(operation: AnyOperation, values: dict[str, Any]) -> Any:
    try:
        return operation.request(**values)
    except ValidationError as error:
        first = error.errors()[0]
        field = str(first["loc"][0]) if first["loc"] else operation.name
        name = field if is_positional(operation.request, field) else as_flag(field)
        said = first["msg"].removeprefix("Value error, ").removeprefix("Input ")
        raise InputError(f"{name}: {said}; got {values.get(field, first['input'])!r}") from error
