"""From a neutral report to text: the page of the book, one line per angle, CSV, JSON, Markdown, HTML and LaTeX."""

from kurbel.render.text import FORMATS as FORMATS
from kurbel.render.text import LAYOUTS as LAYOUTS
from kurbel.render.text import Look as Look
