#!/usr/bin/env python3
"""Lets the program answer every case of a round.

    run.py DIR --abbe build/abbe [--jobs 2] [--limit SECONDS]

The command is the same for every case, without options of its own. A known machine is first learned from its
calibration. Answers go to DIR/answers/NNNN.json with the time they took; what is there already is not asked
again, so an interrupted run goes on, with the same program only. The truths are not read.
"""

import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile
import time


def ask(abbe, arguments, limit):
    """(exit code, stdout, stderr); 124 after `limit` seconds."""
    try:
        done = subprocess.run([abbe, "diagnose", *map(str, arguments)], capture_output=True, text=True, timeout=limit)
        return done.returncode, done.stdout, done.stderr
    except subprocess.TimeoutExpired:
        return 124, "", f"no answer in {limit} s"


def answer(abbe, case, limit):
    """What the program says of one case: {"seconds", "exit", "answer" or null, "messages"}."""
    start, machine = time.monotonic(), ["--machine", case / "machine.json"]
    with tempfile.TemporaryDirectory() as scratch:
        known, code, error = [], 0, ""
        if (case / "calibration.csv").exists():
            model = pathlib.Path(scratch) / "known.json"
            code, _, error = ask(abbe, [case / "calibration.csv", *machine, "--model-out", model], limit)
            known = ["--known", model]
        out = ""
        if code == 0:
            code, out, error = ask(abbe, [case / "recording.csv", *machine, *known, "--format", "json"], limit)
    try:
        said = json.loads(out)
    except ValueError:
        said = None
    return {"seconds": round(time.monotonic() - start, 3), "exit": code, "answer": said, "messages": error[-2000:]}


def frozen(abbe, answers):
    """All cases of a round are answered by one and the same program: its hash and version stay with the answers."""
    version = subprocess.run([abbe, "--version"], capture_output=True, text=True).stdout.strip()
    tool = {"sha256": hashlib.sha256(pathlib.Path(abbe).read_bytes()).hexdigest(), "version": version}
    note = answers / "tool.txt"
    if note.exists() and json.loads(note.read_text())["sha256"] != tool["sha256"]:
        sys.exit(f"run: {answers} has answers of another program; remove them, or use that one")
    note.write_text(json.dumps(tool) + "\n")


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("round", type=pathlib.Path)
    parser.add_argument("--abbe", required=True)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=float, default=600)
    given = parser.parse_args(argv)
    answers = given.round / "answers"
    answers.mkdir(exist_ok=True)
    frozen(given.abbe, answers)
    todo = [c for c in sorted((given.round / "cases").iterdir()) if not (answers / f"{c.name}.json").exists()]
    lost = 0
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        for case, got in zip(todo, pool.map(lambda c: answer(given.abbe, c, given.limit), todo)):
            partial = answers / f"{case.name}.part"
            partial.write_text(json.dumps(got, indent=1) + "\n")
            partial.rename(answers / f"{case.name}.json")
            lost += got["answer"] is None
    print(f"{len(todo)} cases answered, {lost} of them without a readable answer")


if __name__ == "__main__":
    main()
