#!/usr/bin/env python3
"""Checks what docs/architecture.md promises. usage: check.py includes|headers|codes|files|format|constants [COMPILER EIGEN]

includes  every #include of a layer names that layer or one that CMakeLists.txt lets it use; a step of the diagnosis none that comes after it;
          the heavy libraries stay where they belong
headers   every header compiles alone
codes     every message code is exercised by a test
files     no file is longer than 500 lines
constants no two sources of a layer have a constant of their own by the same name, because several may be compiled as one; and every one includes
          the header of each constant that it uses, because it may be compiled alone
format    every file is as `make format` leaves it; other versions of clang-format than Debian 12 has may disagree, so others are not asked
"""
import concurrent.futures
import functools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Libraries that may be included only in the named places (docs/architecture.md, "Libraries").
CONFINED = {
    "tao/pegtl": ["lang/parser.cpp"],
    "CLI/": ["programs/options.cpp"],
    "sleef.h": ["engine/math/c_library.cpp"],
    "Eigen/": ["engine/math/", "engine/features/", "engine/diagnose/"],
    **{f"Eigen/{decomposition}": ["engine/math/", "engine/features/", "engine/diagnose/model/decompositions.cpp"]
       for decomposition in ("Cholesky", "Dense", "Eigenvalues", "LU", "QR", "SVD")},
}

# The folders of engine/diagnose, in the order in which they build on each other (docs/architecture.md, "Diagnosing a recording").
STEPS = ["model", "checks", "baseline", "explanations", "findings", "planning", "values"]


def sources(*suffixes, folders=("engine", "lang", "programs")):
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in suffixes:
                yield path


def layers():
    """Folder -> folders it may include: its own and those that its abbe_layer line in CMakeLists.txt names."""
    text = (ROOT / "CMakeLists.txt").read_text()
    folder, uses = {}, {}
    for name, where, rest in re.findall(r"abbe_layer\((\w+)\s+(\S+)([^)]*)\)", text):
        folder[name] = where
        used = re.search(r"USES\s+(.*)", rest.split("LINKS")[0], re.S)
        uses[name] = set(used.group(1).split()) if used else set()
    table = {folder[n]: {folder[u] for u in uses[n]} | {folder[n]} for n in folder}
    table["programs"] = set(folder.values()) | {"programs"}
    return table


def layer_of(path, table):
    name = str(path)
    return max((f for f in table if name.startswith(f + "/")), key=len, default=None)


def step_of(path):
    match = re.match(r"engine/diagnose/(\w+)/", str(path))
    return STEPS.index(match.group(1)) if match else None


def check_includes():
    table, wrong = layers(), []
    for path in sources(".cpp", ".hpp", ".def"):
        relative = path.relative_to(ROOT)
        own = layer_of(relative, table)
        if own is None:
            wrong.append(f"{relative}: belongs to no layer of CMakeLists.txt")
            continue
        for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
            match = re.match(r'\s*#\s*include\s*(["<])([^">]+)', line)
            if not match:
                continue
            target = match.group(2)
            if match.group(1) == '"' or target.startswith(("engine/", "lang/", "programs/")):
                other = layer_of(pathlib.Path(target), table)
                if other not in table[own]:
                    wrong.append(f"{relative}:{number}: layer {own} may not include {target}")
            step, other = step_of(relative), step_of(target)
            if step is not None and other is not None and other > step:
                wrong.append(f"{relative}:{number}: {STEPS[step]} comes before {STEPS[other]} and may not include {target}")
            for library, places in CONFINED.items():
                if target.startswith(library) and not str(relative).startswith(tuple(places)):
                    wrong.append(f"{relative}:{number}: {target} belongs only in {', '.join(places)}")
    return wrong


@functools.cache
def foreign_headers(path):
    """What a header includes of other projects, by itself or through headers of this one."""
    included = re.findall(r'^#include ([<"])(.*)[>"]', path.read_text(), re.M)
    return frozenset({name for kind, name in included if kind == "<"}.union(
        *(foreign_headers(ROOT / name) for kind, name in included if kind == '"')))


@functools.cache
def own_headers(path):
    """What a file includes of this project, by itself or through headers."""
    included = {ROOT / name for name in re.findall(r'^#include "(.*)"', path.read_text(), re.M)}
    return frozenset(included.union(*(own_headers(header) for header in included if header.exists())))


def chains(headers):
    """The headers in lists in which each is included by the next. All of a list can be compiled as one and each still stands alone: what
    is there before it is only what it includes itself."""
    found = []
    for path in sorted(headers, key=lambda path: (len(own_headers(path)), path)):
        fitting = [chain for chain in found if chain[-1] in own_headers(path)]
        if fitting:
            max(fitting, key=lambda chain: len(own_headers(chain[-1]))).append(path)
        else:
            found.append([path])
    return found


def read_together(wanted):
    """A few sets of foreign headers, of which many of the wanted sets hold a whole one, the largest first."""
    # Reading them takes most of the time of a header: about as long for each, but for Eigen's.
    def cost(names):
        return sum(10 if name.startswith("Eigen") else 1 for name in names)

    def saved(sets):
        return sum(max(cost(s) if s <= names else 0 for s in sets) for names in wanted)
    chosen, candidates = [frozenset()], sorted(set(wanted), key=sorted)
    for _ in range(10):
        chosen.append(max(candidates, key=lambda s: saved([*chosen, s])))
    return sorted(set(chosen), key=cost, reverse=True)


def check_headers(compiler, eigen):
    options = ["-std=c++20", "-Wall", "-Wextra", "-I", str(ROOT), "-isystem", eigen]
    lists = chains(sources(".hpp"))
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        def precompile(numbered):
            number, names = numbered
            together = pathlib.Path(folder) / f"{number}.hpp"
            together.write_text("".join(f"#include <{name}>\n" for name in sorted(names)))
            subprocess.run([compiler, *options, "-x", "c++-header", str(together), "-o", f"{together}.gch"], check=True)
            return names, together
        compiled = list(pool.map(precompile, enumerate(read_together([foreign_headers(chain[0]) for chain in lists]))))

        def compile_alone(chain):
            # Only what the first includes anyway is there before it.
            before = next(together for names, together in compiled if names <= foreign_headers(chain[0]))
            included = [option for path in (before, *chain) for option in ("-include", str(path))]
            run = subprocess.run([compiler, *options, "-fsyntax-only", *included, "-x", "c++", "/dev/null"], capture_output=True, text=True)
            names = ", ".join(str(path.relative_to(ROOT)) for path in chain)
            return [] if run.returncode == 0 else [f"one of {names} does not compile alone:\n{run.stderr}"]
        return [line for lines in pool.map(compile_alone, lists) for line in lines]


def check_codes():
    text = (ROOT / "engine/base/diagnostic_codes.def").read_text()
    codes = re.findall(r"^X\(([EWN]\d{4}),", text, re.M)
    exercised = set()
    for path in (ROOT / "tests").rglob("*"):
        if path.is_file() and path.suffix in (".cpp", ".dmi", ".py", ".json", ".hpp"):
            exercised |= set(re.findall(r"\b[EWN]\d{4}\b", path.read_text(errors="replace")))
    wrong = [f"message code {code} is exercised by no test" for code in codes if code not in exercised]
    if len(set(codes)) != len(codes) or codes != sorted(codes, key=lambda c: (c[1:], c[0])):
        wrong.append("diagnostic_codes.def: codes must be unique and in order of their numbers")
    return wrong


def check_files():
    wrong = []
    for path in sources(".cpp", ".hpp"):
        lines = len(path.read_text(errors="replace").splitlines())
        if lines > 500:
            wrong.append(f"{path.relative_to(ROOT)} has {lines} lines; the limit is 500")
    return wrong


def constants_not_included():
    holders = {}
    for header in sources(".hpp"):
        for declaration in re.findall(r"^(?:inline constexpr|extern const) [^;]*?[;={]", header.read_text(), re.M):
            for name in re.findall(r"\bk[A-Z]\w*", declaration):
                holders.setdefault(name, set()).add(header)
    for path in sources(".cpp"):
        code = re.sub(r'//.*|"(?:\\.|[^"\\])*"', "", path.read_text(errors="replace"))
        for name in sorted(set(re.findall(r"(?<![:.\w])k[A-Z]\w*", code)) & holders.keys()):
            declared_here = re.search(rf"\b{name}\s*(?:\[\w*\])*\s*[={{]", code)
            if not declared_here and not holders[name] & own_headers(path):
                yield f"{path.relative_to(ROOT)} uses {name} without {' or '.join(str(h.relative_to(ROOT)) for h in sorted(holders[name]))}"


def check_constants():
    wrong, table, found = list(constants_not_included()), layers(), {}
    for path in sources(".cpp"):
        relative = path.relative_to(ROOT)
        for declaration in re.findall(r"^(?:inline |static )?const(?:expr|init)? [^;]*?;", path.read_text(errors="replace"), re.M):
            for name in set(re.findall(r"\b(k[A-Z]\w*)\s*(?:\[\w*\])*\s*[={]", declaration.split("{")[0] + "{" if "=" not in declaration.split("{")[0] else declaration)):
                first = found.setdefault((layer_of(relative, table), name), relative)
                if first != relative:
                    wrong.append(f"{relative}: {name} is a constant of {first} too")
    return wrong


def check_format():
    if not shutil.which("clang-format-14"):
        print("format: skipped, clang-format-14 is not installed")
        sys.exit(77)
    files = [str(path) for path in sources(".cpp", ".hpp", folders=("engine", "lang", "programs", "tests"))]
    run = subprocess.run(["clang-format-14", "--dry-run", *files], cwd=ROOT, capture_output=True, text=True)
    unformatted = sorted({line.split(":")[0] for line in run.stderr.splitlines() if "[-Wclang-format-violations]" in line})
    return [f"{pathlib.Path(path).relative_to(ROOT)}: `make format` would change it" for path in unformatted] or run.stderr.splitlines()


def main():
    what = sys.argv[1]
    wrong = {"includes": check_includes, "codes": check_codes, "files": check_files, "format": check_format, "constants": check_constants,
             "headers": lambda: check_headers(*sys.argv[2:])}[what]()
    print("\n".join(wrong) if wrong else f"{what}: good")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
