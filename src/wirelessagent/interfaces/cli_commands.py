"""The tree of commands, one per operation; what a command is about is loaded when that command is chosen."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import click
from click.shell_completion import CompletionItem

from wirelessagent.interfaces.cli_help import family_sections, page, parameter_sections, program_sections
from wirelessagent.interfaces.cli_options import Parameters
from wirelessagent.interfaces.cli_output import tell_page
from wirelessagent.interfaces.commands import COMMANDS, FAMILIES, load
from wirelessagent.operations.operation import AnyOperation

Perform: TypeAlias = Callable[[AnyOperation, dict[str, Any], bool], int]
"""Does an operation with these values of its request's fields, answered in JSON or not; returns the exit code."""

_SUMMARY = "From an operator's words to a certified OFDMA allocation"


def _show_help(ctx: click.Context, parameter: click.Parameter, asked: bool) -> None:
    if asked and not ctx.resilient_parsing:
        assert isinstance(ctx.command, OperationCommand | Commands)
        tell_page(ctx.command.page(ctx, everything=parameter.name == "help_all"))
        ctx.exit()


def _help_option(flags: list[str], text: str) -> click.Option:
    return click.Option(flags, is_flag=True, is_eager=True, expose_value=False, callback=_show_help, help=text)


_HELP = _help_option(["-h", "--help", "help"], "show this page and exit")
_HELP_ALL = _help_option(["--help-all", "help_all"], "show every option and exit, those of the plug-ins included")


class OperationCommand(click.Command):
    """The command of one operation. Its options are its request's; those of plug-ins come when one of them is used."""

    def __init__(self, name: str, perform: Perform) -> None:
        super().__init__(name.split()[-1], callback=self.run, help=COMMANDS[name], add_help_option=False)
        self._operation_name, self._perform = name, perform

    @functools.cached_property
    def operation(self) -> AnyOperation:
        return load(self._operation_name)

    @functools.cached_property
    def _parameters(self) -> Parameters:
        return Parameters(self.operation.request)

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        del ctx
        return [*self._parameters.found(), _HELP, _HELP_ALL]

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        known = {flag for one in self.get_params(ctx) for flag in (*one.opts, *one.secondary_opts)}
        if any(arg.startswith("--") and arg.partition("=")[0] not in known for arg in args):
            self._parameters.find_plugins()
        return super().parse_args(ctx, args)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        if incomplete.startswith("-"):
            self._parameters.find_plugins()
        return super().shell_complete(ctx, incomplete)

    def page(self, ctx: click.Context, *, everything: bool) -> str:
        """The help of the command."""
        if everything:
            self._parameters.find_plugins()
        return page(
            " ".join([ctx.command_path, *self.collect_usage_pieces(ctx)]),
            COMMANDS[self._operation_name],
            parameter_sections(self.get_params(ctx), everything=everything),
            examples=self.operation.examples,
        )

    def run(self, **given: Any) -> int:
        """Do the operation with the values that click found."""
        as_json = given.pop("json")
        return self._perform(self.operation, self._parameters.values(given), as_json)


class Commands(click.Group):
    """All commands, or those of a family, whose names begin with the same word; none is loaded before it is chosen.

    Where an operation has that word for itself, it is what is done without a second word.
    """

    def __init__(self, family: str, perform: Perform, options: Sequence[click.Parameter] = ()) -> None:
        super().__init__(
            family or None, callback=self._run, params=list(options), invoke_without_command=True,
            help=COMMANDS.get(family) or FAMILIES.get(family, _SUMMARY), add_help_option=False,
        )  # fmt: skip
        self._family, self._perform = family, perform
        self._own = OperationCommand(family, perform) if family in COMMANDS else None

    def list_commands(self, ctx: click.Context) -> list[str]:
        del ctx
        if not self._family:
            return list(dict.fromkeys(name.split()[0] for name in COMMANDS))
        start = f"{self._family} "
        return [name.removeprefix(start) for name in COMMANDS if name.startswith(start)]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        name = f"{self._family} {cmd_name}".strip()
        if any(other.startswith(f"{name} ") for other in COMMANDS):
            return Commands(name, self._perform)
        if name in COMMANDS:
            return OperationCommand(name, self._perform)
        if not ctx.resilient_parsing:
            load(name)  # the error says which there are
        return None

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        return [*self.params, _HELP] if self._own is None else self._own.get_params(ctx)

    def page(self, ctx: click.Context, *, everything: bool) -> str:
        """The help of the family, with that of the operation which has its name."""
        commands = family_sections(self._family, self.list_commands(ctx)) if self._family else program_sections()
        return page(
            " ".join([ctx.command_path, *self.collect_usage_pieces(ctx)]),
            self.help or "",
            commands,
            parameter_sections(self.get_params(ctx), everything=everything),
            examples=() if self._own is None else self._own.operation.examples,
        )

    def _run(self, **given: Any) -> int:
        context = click.get_current_context()
        if context.invoked_subcommand is not None:
            return 0
        if self._own is not None:
            return self._own.run(**given)
        tell_page(self.page(context, everything=False))
        return 2
