"""The pages' templates (jinja2) and what they share. Called by page.py and study_page.py. SPDX-License-Identifier: Apache-2.0"""
import pathlib

import jinja2
import markupsafe
from markupsafe import Markup

HERE = pathlib.Path(__file__).resolve().parent
_environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE / "templates"), autoescape=True, trim_blocks=False,
                                  undefined=jinja2.StrictUndefined)
parts = _environment.get_template("parts.html").module


def escape(text):
    """Plain text for HTML that is put together here."""
    return str(markupsafe.escape(text))


def safe(text):
    """HTML made here, not to be escaped again."""
    return Markup(text)


def section(key, title, body, fold=False):
    """What a page shows under one heading; None where there is nothing."""
    if not body:
        return None
    open_part = str(body).partition("<details")[0]
    half = not fold and open_part.count("<figure") == 1 and '<figure class="wide"' not in open_part
    return {"key": key, "title": title, "body": Markup(body), "fold": fold, "half": half}


def render(**what):
    style = Markup((HERE / "style.css").read_text(encoding="utf-8"))
    return _environment.get_template("page.html").render(style=style, **({"facts": "", "before": "", "footer": []} | what))
