#!/usr/bin/env python3
"""Runs every command of README.md and docs/. usage: commands.py PATH-OF-ABBE

A command is an indented line that begins with `build/abbe`, `abbe` or the path of a script in `examples`; one with brackets is a form. They
run in the order of their pages, in a fresh folder that sees the project's examples, tests and docs, and must exit with 0. The program text of
the README is run too.
"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ABBE = pathlib.Path(sys.argv[1]).resolve()


def commands():
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
        for number, line in enumerate(page.read_text().splitlines(), 1):
            if re.match(r" {4,}(build/abbe|abbe|examples/\S+) ", line) and "[" not in line:
                yield f"{page.relative_to(ROOT)}:{number}", shlex.split(line, comments=True)


def readme_program():
    lines = (ROOT / "README.md").read_text().splitlines()
    begin = next(i for i, line in enumerate(lines) if line.startswith("    $$! machine"))
    end = next(i for i in range(begin, len(lines)) if lines[i].strip() == "ENDFIL")
    return "\n".join(line[4:] for line in lines[begin:end + 1]) + "\n"


def main():
    failed = ran = 0
    with tempfile.TemporaryDirectory() as folder:
        for name in ("examples", "tests", "docs"):
            os.symlink(ROOT / name, pathlib.Path(folder) / name)
        built = pathlib.Path(folder) / "build"
        built.mkdir()
        os.symlink(ABBE, built / "abbe")
        path = f"{built}{os.pathsep}{os.environ['PATH']}"
        (pathlib.Path(folder) / "readme.dmi").write_text(readme_program())
        todo = [("README.md program", ["build/abbe", "test", "readme.dmi"]), *commands()]
        for place, command in todo:
            run = subprocess.run(command, cwd=folder, env={**os.environ, "PATH": path}, capture_output=True, text=True)
            ran += 1
            print(f"{'ok  ' if run.returncode == 0 else 'FAIL'} {place}: {' '.join(command)}")
            if run.returncode != 0:
                failed += 1
                print(run.stdout + run.stderr)
    print(f"{ran - failed} passed, {failed} failed")
    return 1 if failed or ran < 10 else 0


if __name__ == "__main__":
    sys.exit(main())
