"""Two programs of NIST, read in place where the checkout has its reference data beside it; skipped elsewhere."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ABBE = sys.argv[1]
DMIS = pathlib.Path(__file__).resolve().parents[3] / "shared/reference/dmis"
failures = []


def check(condition, what):
    print(("ok    " if condition else "FAIL  ") + what)
    if not condition:
        failures.append(what)


if not DMIS.is_dir():
    print(f"skipped: {DMIS} is not there")
    sys.exit(77)

with tempfile.TemporaryDirectory() as folder:
    dmo = pathlib.Path(folder) / "out.dmo"
    run = subprocess.run([ABBE, "run", str(DMIS / "nist_imts_m_clean.dmi"), "--format", "json", "--dmo", str(dmo)], capture_output=True, text=True)
    check(run.returncode == 0, "the part program runs unchanged")
    found = {c["tolerance"]: c for c in json.loads(run.stdout)["characteristics"]}
    check(sorted(found) == [f"TOL{k}" for k in range(1, 8)], "seven characteristics")
    check({c["feature"][0] for c in found.values()} == {"PLN1", "CYL1", "CYL2"}, "of PLN1, CYL1 and CYL2")
    check(abs(found["TOL4"]["reference"] - 31) < 1e-9 and abs(found["TOL7"]["reference"] - 12.5) < 1e-9, "bores of 31.000 and 12.500 mm")
    check(all(abs(found[t]["reference"]) < 1e-9 for t in ("TOL1", "TOL5")), "form 0 on the error-free machine")
    check(all(c["u"] > 0 and c["trapped"] == 0 for c in found.values()), "each has an uncertainty")
    results = dmo.read_text()
    check(len(re.findall(r"^FA\((?:PLN[123]|CYL[12])\) = FEAT/(?:PLANE|CYLNDR)", results, re.M)) == 5, "five measured features in the result file")

    run = subprocess.run([ABBE, "run", str(DMIS / "nist_simple_in.dmi"), "--dmo", str(dmo)], capture_output=True, text=True)
    check(run.returncode == 0, "the simple program runs unchanged")

    def circle(text):
        text = text.replace("$\n", " ")
        values = re.search(r"FA\(A_CIRCLE\)\s*=\s*FEAT/CIRCLE,\s*INNER,\s*CART,\s*([-0-9.,\s]+)", text).group(1)
        return [float(v) for v in values.split(",")]

    check(circle(dmo.read_text()) == circle((DMIS / "nist_simple_output.dmo").read_text()), "its circle is that of the published result file")

sys.exit(1 if failures else 0)
