"""Runs the commands of a study's README.md, so that what the page says is what happens.

A command is an indented line that begins with `build/abbe`. All commands of a page run in order in one fresh folder, which sees the
project's examples and the program. A study's `check` calls run() and then tests what the page states.
"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Page:
    def __init__(self, folder, abbe):
        self._temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self._temporary.name)
        os.symlink(ROOT / "examples", self.folder / "examples")
        (self.folder / "build").mkdir()
        os.symlink(pathlib.Path(abbe).resolve(), self.folder / "build/abbe")
        self.output = []
        for line in (pathlib.Path(folder) / "README.md").read_text().splitlines():
            if re.match(r" {4,}build/abbe ", line):
                self.output.append(self.run(shlex.split(line, comments=True)))
        if not self.output:
            sys.exit("the page has no command")

    def run(self, command):
        """Standard output of a command; a failure ends the check."""
        done = subprocess.run([str(c) for c in command], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        print(f"{'ok  ' if done.returncode == 0 else 'FAIL'} {' '.join(map(str, command))}")
        if done.returncode != 0:
            sys.exit(done.stdout + done.stderr)
        return done.stdout


class Checks:
    def __init__(self):
        self.failed = 0

    def __call__(self, condition, what):
        print(("ok    " if condition else "FAIL  ") + what)
        self.failed += not condition

    def done(self):
        sys.exit(1 if self.failed else 0)
