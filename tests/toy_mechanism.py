"""The mechanism of docs/architecture.md, as it stands there."""

import re
from pathlib import Path

PAGE = Path(__file__).parent.parent / "docs" / "architecture.md"
code = re.search(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
assert code
exec(compile(code.group(1), str(PAGE), "exec"))
