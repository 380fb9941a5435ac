#!/usr/bin/env python3
"""Every effect has its figure, and it is that of today. usage: figures.py PATH-OF-ABBE [--write|--redraw]

docs/figures/effects/EFFECT.svg is what `abbe explain EFFECT --format vega` describes, drawn by docs/figures/render.mjs, and shown in
docs/physics beside the effect. Without an option: nothing is missing, left over or older than its specification, and the libraries that
draw run on the Node of Debian 12. --redraw: draws again and compares the bytes; skipped (77) where `npm ci` was never run. --write: draws.
"""
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs/figures/effects"
NODE = (18, 19, 0)  # Debian 12


def abbe(*words):
    return subprocess.run([sys.argv[1], "explain", *words], check=True, capture_output=True, text=True).stdout


def effects():
    return re.findall(r"^  ([a-z]+\.[a-z_]+) ", abbe().split("\nEffects\n")[1], re.M)


def specifications():
    return {effect: abbe(effect, "--format", "vega") for effect in effects()}


def draw(specs, folder):
    with tempfile.TemporaryDirectory() as temporary:
        files = []
        for effect, spec in specs.items():
            path = pathlib.Path(temporary) / f"{effect}.vl.json"
            path.write_text(spec)
            files += [path, folder / f"{effect}.svg"]
        subprocess.run(["node", ROOT / "docs/figures/render.mjs", *files], check=True)


def admits(range_, version):
    """Does a range as npm writes it admit the version? Only the forms that occur: >=1.2, 6.*, ||."""
    for part in range_.split("||"):
        least = re.fullmatch(r"\s*>=\s*([\d.*]+)\s*", part)
        if least and tuple(int(n) for n in re.findall(r"\d+", least.group(1))) <= version:
            return True
        if not least and not re.fullmatch(r"\s*\d+\.\*\s*", part):
            sys.exit(f"package-lock.json: a range of another form: {range_}")
    return False


def faults(specs):
    for effect, spec in specs.items():
        picture = FOLDER / f"{effect}.svg"
        family = effect.split(".")[0]
        page = ROOT / f"docs/physics/{family}.md"
        if not picture.exists():
            yield f"{effect} has no figure"
        elif hashlib.sha256(spec.encode()).hexdigest() not in picture.read_text():
            yield f"the figure of {effect} is not that of today"
        section = page.read_text().split(f"\n## {effect}\n")[1:]
        if not section or f"](../figures/effects/{effect}.svg)" not in section[0].split("\n## ")[0]:
            yield f"{page.relative_to(ROOT)} does not show the figure of {effect}"
    for picture in FOLDER.glob("*.svg"):
        if picture.stem not in specs:
            yield f"{picture.relative_to(ROOT)} is the figure of no effect"
    for name, package in json.loads((ROOT / "package-lock.json").read_text())["packages"].items():
        if not admits(package.get("engines", {}).get("node", ">=0"), NODE):
            yield f"{name or 'package.json'} does not run on the Node of Debian 12"


def changed(specs):
    with tempfile.TemporaryDirectory() as temporary:
        draw(specs, pathlib.Path(temporary))
        for effect in specs:
            if (pathlib.Path(temporary) / f"{effect}.svg").read_bytes() != (FOLDER / f"{effect}.svg").read_bytes():
                yield f"the figure of {effect} is drawn otherwise today"


def main():
    if "--redraw" in sys.argv and not (ROOT / "node_modules").exists():
        print("skipped: `npm ci` was never run here")
        return 77
    specs = specifications()
    if not specs:
        sys.exit("`abbe explain` lists no effects as this script expects them")
    if "--write" in sys.argv:
        for old in FOLDER.glob("*.svg"):
            old.unlink()
        draw(specs, FOLDER)
    wrong = list(changed(specs) if "--redraw" in sys.argv else faults(specs))
    print("\n".join(wrong + ["run `make figures` and look at them"]) if wrong else f"figures: {len(specs)} good")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
