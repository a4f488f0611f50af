"""Form of the name of a file."""

import os

from kurbel.declared.forms.scalars import Scalar
from kurbel.declared.keys import Schema
from kurbel.declared.reading import shown
from kurbel.errors import refused


class FilePath(Scalar):
    """The path of a file, relative to the machine file; becomes a path that can be opened."""

    def parse(self, text: str, folder: str) -> str:
        full = os.path.join(folder, text)
        if os.path.isdir(full):
            refused(f"'{shown(text)}' is a folder; name the file in it")
        if os.path.exists(full) and not os.path.isfile(full):
            refused(f"'{shown(text)}' is a device or a pipe; name a file that can be read again")
        if not os.path.isfile(full):
            refused(f"there is no file '{shown(text)}' in {shown(folder) if folder else 'the working directory'}")
        return full

    def expected(self) -> str:
        return "the name of a file"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "string", "minLength": 1}
