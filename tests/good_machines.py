"""Machine files that read well: for the tests of the reader, of the schema, and as seeds of the fuzz."""

from pathlib import Path

ALL = {
    path.stem: path.read_text("utf-8")
    for path in sorted(Path(__file__).parent.glob("machine_file/good/*.yaml"))
}
DEMO = ALL["demo"]
