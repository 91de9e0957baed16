"""A mechanism in a notebook: the page that moves, in a frame that can do nothing else; a picture where scripts are off."""

from __future__ import annotations

import html
from typing import Any

#: A notebook with a few of these stays small (bytes).
LARGEST = 300_000

#: Rows of the motion that are tried, until it is small enough.
ROWS = (400, 200, 100, 50, 25, 12)


def shown(m: Any, request: dict[str, Any]) -> str:
    """The page in a sandboxed frame, with a picture for readers whose scripts are off; of what is too large for that the picture alone.
    Below it stands why the motion ends before its time, if it does."""
    for rows in ROWS:
        page, picture, error = m._visualize(request, rows)
        why = "" if error is None else f"<pre>{html.escape(str(error))}</pre>"
        text = framed(page, picture) + why
        if len(text.encode()) <= LARGEST:
            return text
    text = f"<div>{picture}</div>{why}"
    return text if len(text.encode()) <= LARGEST else f"<pre>{html.escape(repr(m))}</pre>"


def without_motion(m: Any, why: Exception) -> str:
    """What it is, and why it cannot be shown."""
    return f"<pre>{html.escape(repr(m))}\n\n{html.escape(str(why))}</pre>"


def framed(page: str, picture: str) -> str:
    """The frame takes the page's script and nothing of the notebook's: it has an origin of its own."""
    # a picture alone would be hidden where scripts run: what is within `noscript` is shown where they do not
    return (
        f'<iframe sandbox="allow-scripts" srcdoc={_quoted(page)} title="the mechanism, moving" '
        'style="width:100%;height:640px;border:0"></iframe>'
        f"<noscript>{picture}</noscript>"
    )


def _quoted(page: str) -> str:
    """A page as the value of an attribute: of its characters only `&` and the quote mean something else there."""
    page = page.replace("&", "&amp;")
    if page.count("'") < page.count('"'):
        return "'" + page.replace("'", "&#39;") + "'"
    return '"' + page.replace('"', "&quot;") + '"'
