#!/usr/bin/env python3
"""docs/language.md ends with what `abbe explain --markdown` prints. usage: language.py PATH-OF-ABBE [--write]"""
import pathlib
import subprocess
import sys

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs/language.md"
MARK = "The rest of this page is printed by `abbe explain --markdown`; a test compares.\n\n"

tables = subprocess.run([sys.argv[1], "explain", "--markdown"], check=True, capture_output=True, text=True).stdout
intro, now = PAGE.read_text().split(MARK)
if "--write" in sys.argv:
    PAGE.write_text(intro + MARK + tables)
elif now != tables:
    sys.exit("docs/language.md is not what `abbe explain --markdown` prints; run `python3 tests/docs/language.py build/abbe --write` and review")
print("language: good")
