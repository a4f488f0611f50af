"""Machine files from Python, where options of the command line are parameters: `overrides`, not `--set`."""

import os
import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from kurbel.errors import KurbelError, MachineFileError, NoSolutionError, RuleError
from kurbel.machine import Machine
from kurbel.machine_file import reader

_PARAMETERS = {"set": "overrides"}
"""Options that have another name in Python."""
_COMPLETE_QUESTIONS = (
    (
        "give --vary KEY=low:high and 'KEY_VALUE = value', two of both, or --least or --greatest",
        "give vary={KEY: (low, high)} and wanted='KEY_VALUE = value', two of both, or least= or greatest=",
    ),
    ("; kurbel sweep compares words", "; kurbel.sweep compares words"),
)
_OF_KEY = re.compile(r"--vary ([^\s=:]+)(?=[:=])")
_OPTION = re.compile(r"(?<![\w-])--([a-z][a-z-]*)")


def in_python(text: str, varied: str = "vary") -> str:
    """Return a message with the parameters of Python in the place of options; varied: that of keys that vary.

    >>> in_python("--vary bore: this key is varied twice", varied="inputs")
    "inputs['bore']: this key is varied twice"
    >>> in_python("--where c_m < 5: m/s; --set bore=4: 4 has no unit")
    "'where' c_m < 5: m/s; 'overrides' bore=4: 4 has no unit"
    """
    for sentence, in_words in _COMPLETE_QUESTIONS:
        text = text.replace(sentence, in_words)
    text = _OF_KEY.sub(rf"{varied}['\1']", text)

    def parameter(option: re.Match[str]) -> str:
        name = varied if option[1] == "vary" else option[1]
        return f"'{_PARAMETERS.get(name, name)}'"

    return _OPTION.sub(parameter, text)


@contextmanager
def errors_of_python(varied: str = "vary") -> Iterator[None]:
    """Raise the errors of what is done within it with messages for Python; varied: see `in_python`."""
    try:
        yield
    except KurbelError as error:
        _reword(error, lambda text: in_python(text, varied))
        raise


def _reword(error: KurbelError, reworded: Callable[[str], str]) -> None:
    """Change the message of an error, and those of its faults."""
    error.args = tuple(reworded(str(argument)) for argument in error.args)
    if isinstance(error, (MachineFileError, RuleError)):
        error.faults = type(error.faults)(
            fault._replace(message=reworded(fault.message), override=reworded(fault.override))
            for fault in error.faults
        )
    if isinstance(error, NoSolutionError):
        remedy = error.remedy
        error.remedy = lambda: reworded(remedy())


def load(path: str | os.PathLike[str], overrides: Iterable[str] = (), case: str = "") -> Machine:
    """Return the machine that a file describes; "-" is standard input.

    overrides: values that replace those of the file, such as `cylinders.0.bore=450 mm`; case: the name of one of its
    load cases, whose values they replace, too. Raises UsageError for an override that cannot be set, MachineFileError
    with every fault of the file, UnreadableFileError if the file cannot be read.
    """
    with errors_of_python():
        return reader.load(path, overrides, case)


def loads(text: str, name: str = "<text>", overrides: Iterable[str] = ()) -> Machine:
    """Return the machine that a text describes; name: used as the file name in messages; overrides: see `load`.

    Raises MachineFileError with every fault of the text.
    """
    with errors_of_python():
        return reader.loads(text, name, overrides)
