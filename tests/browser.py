"""A page as a headless Chromium has it."""

import functools
import http.server
import re
import shutil
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

CHROMIUM = (
    shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
)
_QUIET = (
    *(
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-quic",
        "--no-first-run",
        "--disable-sync",
    ),
    "--disable-dev-shm-usage",  # a container may have too little of it for several at once
    *("--disable-background-networking", "--disable-component-update", "--enable-logging=stderr"),
)
_CONSOLE = re.compile(r'CONSOLE[^"]*"(.*?)", source')


def dumped(url: str, profile: Path, *options: str) -> tuple[str, list[str]]:
    """Return the page at the end of its scripts as HTML, and what it wrote to the console."""
    assert CHROMIUM
    done = subprocess.run(
        [
            CHROMIUM,
            *_QUIET,
            f"--user-data-dir={profile}",
            "--virtual-time-budget=20000",
            *options,
            "--dump-dom",
            url,
        ],
        capture_output=True,
        encoding="utf-8",
        check=True,
        timeout=120,  # a browser that hangs must not hang the tests
    )
    return done.stdout, _CONSOLE.findall(done.stderr)


class _Alone(http.server.SimpleHTTPRequestHandler):
    """Serves files, and forbids a page to ask for anything from elsewhere: the console shows if it does."""

    def end_headers(self) -> None:
        self.send_header(
            "Content-Security-Policy", "default-src 'self' 'unsafe-inline' data: blob:"
        )
        super().end_headers()

    def log_message(self, *_: object) -> None:
        pass


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """Serve a folder on this machine; yield its address."""
    server = http.server.ThreadingHTTPServer(
        ("127.0.0.1", 0), functools.partial(_Alone, directory=str(folder))
    )
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
