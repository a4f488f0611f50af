"""The manual page kurbel.1, from the help of all commands."""

from __future__ import annotations

import re

import click

from kurbel.cli import COMMANDS, kurbel
from kurbel.cli.group import KurbelCommand, exit_statuses

ENVIRONMENT = {
    "NO_COLOR": "No colours on a terminal.",
    "FORCE_COLOR": "Colours in a pipe, too.",
    "COLUMNS": "Width of text into a pipe.",
    "KURBEL_DEBUG": "Shows where a bug in kurbel happened.",
}


def page() -> str:
    """Return the page in the macros of man(7)."""
    lines = [
        ".TH KURBEL 1",
        ".SH NAME",
        r"kurbel \- calculate crank drives",
        ".SH SYNOPSIS",
        r".B kurbel",
        r"\fICOMMAND\fR [\fIOPTIONS\fR] [\fIFILE\fR]",
        ".SH DESCRIPTION",
        *_prose(kurbel.help or ""),
        ".SH COMMANDS",
    ]
    for word in COMMANDS:
        lines += _command(word)
    lines += [".SH EXIT STATUS", *_text(exit_statuses().removeprefix("Exit status: "))]
    lines += [".SH ENVIRONMENT"]
    for name, meaning in ENVIRONMENT.items():
        lines += [".TP", f".B {name}", *_text(meaning)]
    return "\n".join(lines) + "\n"


def _command(word: str) -> list[str]:
    """Return the lines of a command: usage, help, options."""
    command = kurbel.get_command(click.Context(kurbel), word)
    assert isinstance(command, KurbelCommand)
    names = kurbel.context_settings["help_option_names"]
    context = click.Context(command, info_name=f"kurbel {word}", help_option_names=names)
    usage = " ".join(command.get_usage(context).removeprefix("Usage: ").split())
    lines = [f".SS {_escaped(usage)}", *_prose(command.help or "")]
    lines += [".PP", ".EX", _escaped(COMMANDS[word].example), ".EE"]
    for parameter in command.get_params(context):
        record = parameter.get_help_record(context)
        if isinstance(parameter, click.Option) and record:
            option, meaning = record
            lines += [".TP", f".B {_escaped(option)}", *_text(meaning)]
    return lines


def _prose(text: str) -> list[str]:
    """Return paragraphs; one that click keeps as it is becomes an example."""
    lines = []
    for paragraph in re.sub(r"^ {4}", "", text, flags=re.M).strip().split("\n\n"):
        lines.append(".PP")
        if paragraph.startswith("\b\n"):
            kept = paragraph.removeprefix("\b\n").splitlines()
            lines += [".EX", *(_escaped(line) for line in kept), ".EE"]
        else:
            lines += _text(paragraph)
    return lines


def _text(text: str) -> list[str]:
    return [_escaped(" ".join(text.split()))]


def _escaped(text: str) -> str:
    r"""Return a line of text in which nothing is a request of roff.

    >>> print(_escaped(".a -b \\c"))
    \&.a \-b \ec
    """
    escaped = text.replace("\\", r"\e").replace("-", r"\-")
    return rf"\&{escaped}" if escaped.startswith((".", "'")) else escaped
