#!/usr/bin/env python3
"""Makes docs/evidence.md and its figures: generates a round, lets the program answer, scores, draws, fills in.

    evidence.py --abbe build/abbe [--round final] [--scale 1] [--secret HEX] [--work build/evidence]

Round, scale and secret are those that the page records, unless given. The page keeps its prose; what stands between
`<!-- evidence NAME -->` and `<!-- end -->` is written here. An interrupted round goes on where it stopped. Figures
need Node and `npm ci` in the top folder.
"""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys

try:
    import ceiling
    import follow
    import plots
    import score
    import summary
except ModuleNotFoundError as missing:
    sys.exit(f"evidence: needs {missing.name} (Debian: python3-numpy)")

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PAGE = ROOT / "docs/evidence.md"
RECORD = re.compile(r"make evidence ROUND=(\w+) SCALE=([\d.]+) SECRET=(\w+)")


def step(script, *words):
    subprocess.run([sys.executable, "-B", HERE / script, *map(str, words)], check=True)


def generated(work, given):
    """The round in `work`, made unless it is there; another one there is not overwritten."""
    secret = work / "sealed/secret.txt"
    if not (work / "SEAL.txt").exists():
        step("generate.py", "--round", given.round, "--scale", given.scale, "--secret", given.secret, "--out", work, "--jobs", given.jobs)
    elif secret.read_text().strip() != f"{given.round} {given.secret}":
        sys.exit(f"evidence: {work} holds another round; remove it or choose another --work")


def drawn(specifications, work, folder):
    """SVG files of all figures that have data, and nothing else in the folder; returns their names."""
    names = plots.written(specifications, work / "plots")
    files = [work / f"plots/{name}{ending}" for name in names for ending in (".vl.json", ".svg")]
    subprocess.run(["node", ROOT / "docs/figures/render.mjs", *map(str, files)], check=True)
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.svg"):
        old.unlink()
    for name in names:
        shutil.copyfile(work / f"plots/{name}.svg", folder / f"{name}.svg")
    return names


def record(given, result, tool):
    kinds = len(result["rows"])
    return (
        f"    make evidence ROUND={given.round} SCALE={given.scale:g} SECRET={given.secret}\n\n"
        f"{kinds} cases, {result['seals_verified']} seals verified, {result['measures']['answered']} answered by {tool['version']} "
        f"(program {tool['sha256'][:16]}); {result['measures']['seconds']['median']:.0f} s a case in the middle.\n"
    )


def filled(text, blocks):
    """The page with its marked parts replaced. Unknown and left-over names end it: nothing on the page may be stale."""
    used = set()

    def part(found):
        name = found.group(1)
        if name not in blocks:
            sys.exit(f"evidence: the page asks for '{name}'; there are {', '.join(sorted(blocks))}")
        used.add(name)
        return f"<!-- evidence {name} -->\n{blocks[name].strip(chr(10))}\n<!-- end -->"

    out = re.sub(r"<!-- evidence ([\w ]+) -->\n.*?<!-- end -->", part, text, flags=re.S)
    if unused := set(blocks) - used:
        sys.exit(f"evidence: the page has no place for {', '.join(sorted(unused))}")
    return out


def blocks_of(result, followed, names, specifications, first):
    """What the page shows, by the names of its marks."""
    figures = {}
    for name, specification in specifications.items():
        shown = f"![{plots.title_of(specification)}](evidence/{name}.svg)"
        group = "before and after" if name.startswith("before_after") else f"figure {name}"
        figures.setdefault(group, []).extend([shown] if name in names else [])
    figures = {group: "\n\n".join(shown) or "No case of this round shows it." for group, shown in figures.items()}
    head = {"headline": summary.headline(result), "in short": summary.in_short(result, followed)}
    return {"round": first, **head, **score.tables(result), "ideal": ceiling.text(ceiling.rows()), "decoys": follow.text(followed), **figures}


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    found = RECORD.search(PAGE.read_text())
    recorded = found.groups() if found else ("final", "1", None)
    parser.add_argument("--abbe", type=pathlib.Path, required=True)
    parser.add_argument("--round", default=recorded[0], choices=("development", "rehearsal", "final"))
    parser.add_argument("--scale", type=float, default=float(recorded[1]))
    parser.add_argument("--secret", default=recorded[2])
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/evidence")
    parser.add_argument("--page", type=pathlib.Path, default=PAGE)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--answered", action="store_true", help="score and draw what is in --work; ask the program nothing")
    given = parser.parse_args(argv)
    if not given.secret:
        parser.error("the page records no round yet: give --secret")
    if not given.answered:
        generated(given.work, given)
        step("run.py", given.work, "--abbe", given.abbe, "--jobs", given.jobs)
    result = score.scored(given.work)
    (given.work / "results.json").write_text(json.dumps(result, indent=1) + "\n")
    followed = follow.followed(given.work, None if given.answered else given.abbe)
    specifications = {**plots.figures(result, followed), **plots.residual_maps(result, given.work / "answers")}
    names = drawn(specifications, given.work, given.page.with_suffix(""))
    tool = json.loads((given.work / "answers/tool.txt").read_text())
    blocks = blocks_of(result, followed, names, specifications, record(given, result, tool))
    given.page.write_text(filled(given.page.read_text(), blocks))
    print(f"{given.page} and {len(names)} figures")


if __name__ == "__main__":
    main()
