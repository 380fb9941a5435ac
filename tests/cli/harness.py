"""Shared by the command-line tests. A test file is tests/cli/NAME_test.py, called with the path of abbe; it defines classes derived
from harness.Case and ends with harness.main()."""
import csv
import io
import itertools
import json
import pathlib
import pty
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# A length of 100 mm along x in the middle of the machine coord3-mc16, between two touches.
LENGTH = """DMISMN/'a length',4.0
UNITS/MM,ANGDEC
S(P)=SNSDEF/PROBE,INDEX,POL,0.0,0.0,0.0,0.0,-1.0,300.0,4.0
SNSLCT/S(P)
D(M)=DATSET/MCS
D(R)=TRANS/XORIG,800,YORIG,500,ZORIG,-700
F(A)=FEAT/POINT,CART,0,0,0,-1,0,0
MEAS/POINT,F(A),1
PTMEAS/CART,0,0,0,-1,0,0
ENDMES
F(B)=FEAT/POINT,CART,100,0,0,1,0,0
MEAS/POINT,F(B),1
PTMEAS/CART,100,0,0,1,0,0
ENDMES
T(LEN)=TOL/DISTB,NOMINL,100.0,-0.01,0.01,PT2PT
OUTPUT/FA(A),FA(B),TA(LEN)
ENDFIL
"""


# Of the 25 touches of a sphere so many that they see it from all sides: the pole, and four each at 45, 22.5 and 0 degrees of elevation.
FROM_ALL_SIDES = (1, 6, 8, 10, 12, 14, 15, 16, 17, 18, 20, 22, 24)


def sphere(orientations=5, points=FROM_ALL_SIDES):
    """The sphere of examples/iso10360/form_and_size_5x25.dmi in its first orientations, each of these points: a diagnosis of it takes less time."""
    def kept(match):
        orientation, *point = map(int, match["of"].split("_"))
        return match[0] if orientation <= orientations and set(point) <= set(points) else ""
    text = (ROOT / "examples/iso10360/form_and_size_5x25.dmi").read_text()
    text = re.sub(r"\$\$ Orientation (?P<of>\d).*?(?=\$\$ Orientation|F\(ALL\))", kept, text, flags=re.S)
    text = re.sub(r"F\(P(?P<of>\d_\d+)\)=.*?ENDMES\n", kept, text, flags=re.S)
    text = re.sub(r",(\$\n +)?FA\(P(?P<of>\d_\d+)\)", kept, text)
    return re.sub(r"T\(C_\d(?P<of>\d)\).*\nOUTPUT.*\n", kept, text)


def balls(centres, directions):
    """A program that touches balls of 30 mm, each from these directions, with the stylus of LENGTH."""
    touches = lambda centre: "".join("PTMEAS/CART," + ",".join(f"{c + 15 * n:.6f}" for c, n in zip(centre, along)) + "".join(f",{n:.9f}" for n in along) + "\n"
                                     for along in directions)
    return LENGTH.split("D(R)=")[0] + "".join(
        f"F(B{k})=FEAT/SPHERE,OUTER,CART,{','.join(map(str, centre))},30\nMEAS/SPHERE,F(B{k}),{len(directions)}\n{touches(centre)}ENDMES\n"
        for k, centre in enumerate(centres)) + "ENDFIL\n"


def at_least(count, outcomes):
    """Whether so many outcomes hold, of which no more are asked for than that takes."""
    return sum(1 for _ in itertools.islice(filter(None, outcomes), count)) == count


class Case(unittest.TestCase):
    abbe_path = ""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def abbe(self, *args, code=0, stdout=subprocess.PIPE):
        """Runs abbe in the temporary folder and checks the exit code, which may be one of several."""
        if args[:1] == ("diagnose",) and "--threads" not in args:
            args = (*args, "--threads", 1)   # as many tests as processors run at a time
        done = subprocess.run([self.abbe_path, *map(str, args)], cwd=self.folder, stdout=stdout, stderr=subprocess.PIPE, text=True,
                              errors="replace", timeout=120)
        self.assertIn(done.returncode, code if isinstance(code, tuple) else (code,), f"exit code of abbe {args}\n{done.stdout}\n{done.stderr}")
        return done

    def sphere(self, **kept):
        """The path of that program."""
        return self.write("sphere.dmi", sphere(**kept))

    def pseudo_terminal(self):
        """Its two ends. A test is skipped where the system has none, as in a bare root without /dev/pts."""
        try:
            return pty.openpty()
        except OSError as error:
            self.skipTest(f"no pseudo-terminal: {error}")

    def refused(self, message_code, *args):
        """Exit code 2, the message on stderr, nothing on stdout. Returns stderr."""
        done = self.abbe(*args, code=2)
        self.assertIn(message_code, done.stderr)
        self.assertEqual(done.stdout, "")
        return done.stderr

    def changed(self, path, change, name="changed.csv"):
        """A recording with every row passed through `change`."""
        lines = path.read_text().splitlines()
        comments = [line for line in lines if line.startswith("#")]
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        rows = [r for r in (change(dict(r)) for r in rows) if r is not None]
        out = io.StringIO()
        writer = csv.DictWriter(out, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        return self.write(name, "\n".join(comments) + "\n" + out.getvalue())

    def run_json(self, *args):
        return json.loads(self.abbe("run", *args, "--format", "json").stdout)


def main():
    Case.abbe_path = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
