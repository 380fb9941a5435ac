"""Sealing: the truth of every case is bound by a hash that is there before the data appear, and opened after
the answers.

The seal of a case is SHA-256(salt || truth bytes); the salt comes from the secret of the round, so that
nobody can try truths until one fits, and the truth holds the SHA-256 of the data files, so that they cannot
be exchanged either.
"""

import hashlib
import json
import pathlib

from portable import np


def salt(secret, number):
    return hashlib.sha256(f"salt {secret} {number}".encode()).digest()


def seal(secret, number, truth):
    return hashlib.sha256(salt(secret, number) + truth).hexdigest()


def generator(secret, *names):
    """Random numbers that belong to a name: numpy's PCG64, seeded from a hash."""
    digest = hashlib.sha256(" ".join([secret, *map(str, names)]).encode()).digest()
    return np.random.Generator(np.random.PCG64(int.from_bytes(digest, "big")))


def to_bytes(truth):
    """JSON with sorted keys and nine digits: the same bytes wherever it is made."""

    def plain(v):
        if isinstance(v, dict):
            return {k: plain(x) for k, x in v.items()}
        if isinstance(v, (list, tuple, np.ndarray)):
            return [plain(x) for x in v]
        if isinstance(v, (np.integer, int)) and not isinstance(v, bool):
            return int(v)
        if isinstance(v, (np.floating, float)):
            return float(f"{float(v):.9g}")
        return bool(v) if isinstance(v, np.bool_) else v

    return (json.dumps(plain(truth), indent=1, sort_keys=True) + "\n").encode()


def digest_of(folder):
    """One hash of all data files of a case."""
    h = hashlib.sha256()
    for path in sorted(pathlib.Path(folder).iterdir()):
        h.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return h.hexdigest()


def verified(root, sealed=None):
    """Opens the truths of a round, which are in `sealed` or in root/sealed: {number: truth}.

    Raises ValueError for anything that does not fit its seal."""
    root = pathlib.Path(root)
    sealed = pathlib.Path(sealed or root / "sealed")
    secret = (sealed / "secret.txt").read_text().strip()
    seals = dict(line.split() for line in (root / "SEAL.txt").read_text().splitlines() if not line.startswith("#"))
    truths = {}
    for number, expected in sorted(seals.items()):
        raw = (sealed / f"{number}.json").read_bytes()
        if seal(secret, number, raw) != expected:
            raise ValueError(f"case {number}: the truth is not the one that was sealed")
        truths[number] = json.loads(raw)
        if digest_of(root / "cases" / number) != truths[number]["data_sha256"]:
            raise ValueError(f"case {number}: the data are not those that were sealed")
    return truths
