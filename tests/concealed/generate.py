#!/usr/bin/env python3
"""Makes a round of concealed cases.

    generate.py --round development|rehearsal|final --out DIR [--sealed DIR/sealed] [--scale 0.1] [--only KIND] [--secret HEX]

DIR/SEAL.txt     hashes of the truths, written before the data appear
DIR/cases/NNNN/  machine.json, recording.csv and, for a known machine, calibration.csv
DIR/sealed/      secret.txt and the truths NNNN.json; keep it away from those who answer until they have answered
"""

import argparse
import concurrent.futures
import pathlib
import secrets
import sys

try:
    import cases
    from seal import generator, seal, to_bytes
except ModuleNotFoundError as missing:
    sys.exit(f"generate: needs {missing.name} (Debian: python3-numpy)")

PUBLIC = "development round of the concealed cases"


def write_case(job):
    secret, number, spec, root, sealed = job
    data, truth = cases.make(secret, number, spec)
    raw = to_bytes(truth)
    folder = root / "cases.tmp" / number
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in data.items():
        (folder / name).write_text(text)
    (sealed / f"{number}.json").write_bytes(raw)
    return number, seal(secret, number, raw)


def counts_at(scale, only=None):
    """How many cases of each kind a round of this scale has; of one kind `only`."""
    return {kind: max(1, round(n * scale)) if only in (None, kind) else 0 for kind, n in cases.COUNTS.items()}


def numbered(secret, counts, final):
    """Cases in random order: the number tells nothing."""
    specs = cases.plan(counts, final)
    order = generator(secret, "order").permutation(len(specs))
    return [(f"{i + 1:04d}", specs[k]) for i, k in enumerate(order)]


def write_round(kind, secret, numbered_cases, root, sealed, jobs=1):
    """Writes all cases, their truths and their seals; the folder `cases` appears last, when everything is there."""
    for folder in (root, sealed):
        folder.mkdir(parents=True, exist_ok=True)
    (sealed / "secret.txt").write_text(secret + "\n")
    work = [(secret, *case, root, sealed) for case in numbered_cases]
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        seals = list(pool.map(write_case, work, chunksize=4))
    head = f"# SHA-256(salt || truth) of every case of the {kind} round\n"
    (root / "SEAL.txt").write_text(head + "".join(f"{n} {h}\n" for n, h in sorted(seals)))
    (root / "cases.tmp").rename(root / "cases")


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--round", choices=("development", "rehearsal", "final"), required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--sealed", type=pathlib.Path, help="where the truths go, default DIR/sealed")
    parser.add_argument("--scale", type=float, default=1.0)
    parser.add_argument("--only", choices=cases.COUNTS, help="cases of one kind: many nulls, for a closer look at false alarms")
    parser.add_argument("--secret", help="hexadecimal; makes a published round again")
    parser.add_argument("--jobs", type=int, default=1)
    given = parser.parse_args(argv)
    if (given.out / "cases").exists():
        parser.error(f"{given.out}/cases exists already: choose another folder")
    secret = given.secret or (PUBLIC if given.round == "development" else secrets.token_hex(16))
    secret = f"{given.round} {secret}"
    counts = counts_at(given.scale, given.only)
    sealed = given.sealed or given.out / "sealed"
    numbers = numbered(secret, counts, given.round == "final")
    write_round(given.round, secret, numbers, given.out, sealed, given.jobs)
    print(f"{len(numbers)} cases in {given.out}/cases; truths in {sealed}")


if __name__ == "__main__":
    main()
