"""Acceptance tests from the command line: `abbe machine screen`, examples/iso10360 and docs/acceptance_tests.md.
usage: acceptance_test.py ABBE"""
import csv
import itertools
import json
import math
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ABBE = pathlib.Path(sys.argv[1]).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples" / "iso10360"
PORTAL = EXAMPLES / "portal-2009.json"


def run(*arguments, cwd=ROOT):
    return subprocess.run([str(a) for a in arguments], capture_output=True, text=True, cwd=cwd)


def screening(machine, *options):
    done = run(ABBE, "machine", "screen", machine, "--machines", "300", "--format", "json", *options)
    assert done.returncode == 0 and done.stderr == "", done
    return json.loads(done.stdout)


def changed(folder, **changes):
    """portal-2009 with other values: specification={...} or probe={...}."""
    machine = json.loads(PORTAL.read_text())
    for key, values in changes.items():
        machine[key].update(values)
    path = pathlib.Path(folder) / "changed.json"
    path.write_text(json.dumps(machine))
    return path


def test_reports():
    old, new = screening("coord3-mc16"), screening(PORTAL)
    assert [line["test"] for line in old["lines"]] == ["E0"] * 7 and old["probe"] == []
    assert set(old["specification"]) == {"standard", "mpe", "v_min", "v_max", "longest_share"}
    assert [line["name"] for line in new["lines"][7:]] == ["yz+", "yz-", "xz+", "xz-"]
    assert new["lines"][7]["tip_mm"] == [150, 0, -300]
    assert abs(max(new["lines"][3]["mpe_um"]) - 9) < 1e-9
    assert all(line["error_over_mpe"]["largest"] <= 1 for line in new["lines"])
    assert [check["name"] for check in new["probe"]] == ["R0", "P_Form.Sph.1x25", "P_Size.Sph.1x25"]
    assert all(0.5 < check["share_passed"] <= 1 for check in new["probe"])
    assert new["messages"] == [], new["messages"]
    text = run(ABBE, "machine", "screen", PORTAL, "--machines", "300").stdout
    told = " ".join(text.split())
    # MPE(l) = 4 um + 4 um/m of E0, 4.5 um + 4 um/m of E150
    for piece in ("E0 x 1056.0 8.22", "E150 yz+ 845.2 7.88", "R0 3.50", "P_Form.Sph.1x25 2.50", "P_Size.Sph.1x25 1.50"):
        assert piece in told, text
    assert [check["limit_um"] for check in new["probe"]] == [3.5, 2.5, 1.5]
    for check in new["probe"]:
        assert f"{check['limit_um']:.2f} {check['median_um']:.2f} {100 * check['share_passed']:.1f} %" in told, text
    drawn = int(re.search(r"virtual machines drawn (\d+)", told)[1])
    assert f"300 {100 * 300 / drawn:.1f} % failed the MPE" in told, text
    assert "55 lengths" in text and "E150  xz-" in text and "P_Size.Sph.1x25" in text, text
    assert "E150: MPE(l) = 4.5 um + 4 um/m" in run(ABBE, "machine", "show", PORTAL).stdout


def test_messages(folder):
    noisy = changed(folder, probe={"sd_um": [1.5, 1.5, 1.5]})
    done = run(ABBE, "machine", "screen", noisy, "--machines", "100")
    assert done.returncode == 0 and done.stderr.count("W0418") == 2, done
    assert "R0" in done.stderr and "P_Form.Sph.1x25" in done.stderr
    done = run(ABBE, "machine", "screen", changed(folder, specification={"standard": "ISO 10360-2:2001"}))
    assert done.returncode == 2 and done.stderr.count("E0414") == 2 and "e150_mpe" in done.stderr, done


def samples(folder, program, machine, machines):
    """{characteristic: [value on each machine]}; repeated evaluations one after the other."""
    path = pathlib.Path(folder) / "samples.csv"
    done = run(ABBE, "run", EXAMPLES / program, "--machine", machine, "--machines", machines, "--csv", path)
    assert done.returncode == 0, done
    values = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            values.setdefault((row["characteristic"], row["occurrence"], float(row["reference"])), []).append(float(row["value"]))
    return values


def indicators(lengths, mpe_mm, machines):
    return [min(mpe_mm(ref) / abs(values[i] - ref) for (_, _, ref), values in lengths.items()) for i in range(machines)]


def test_programs_are_the_screening(folder):
    """Without noise, v from the lengths that E0 and E150 print is v of the screening. The tip touches the ends of the blocks from
    outside, so readings lie 2 mm beyond those of the screening: about one percent in v, more where 25 mm decide."""
    quiet = changed(folder, probe={"sd_um": [0, 0, 0]})
    n = 100
    e0 = indicators(samples(folder, "e0.dmi", quiet, n), lambda l: min(0.004 + 4e-6 * l, 0.009), n)
    e150 = indicators(samples(folder, "e150.dmi", quiet, n), lambda l: 0.0045 + 4e-6 * l, n)
    v = [min(pair) for pair in zip(e0, e150)]
    assert all(0.95 < one < 2.05 for one in v), (min(v), max(v))
    first = json.loads(run(ABBE, "machine", "show", quiet, "--format", "json").stdout)["virtual_machine"]
    assert abs(v[0] / first["v"] - 1) < 0.05, (v[0], first)
    assert any(b < a for a, b in zip(e0, e150)), "E150 never decides"


def test_repeatability(folder):
    """R0 of one length is the range of three normal values of sqrt(2) 0.5 um: mean 1.6926, standard deviation 0.8884 of them. Four
    standard deviations of a mean over 1000 machines: a false alarm of 6 in 100 000, and the seed is fixed."""
    run(ABBE, "run", EXAMPLES / "r0.dmi", "--csv", "r0.csv", cwd=folder)
    done = run(EXAMPLES / "repeatability", "r0.csv", cwd=folder)
    assert done.returncode == 0, done
    mean_um = float(done.stdout.split("mean ")[1].split()[0])
    sd_um = 2 ** 0.5 * 0.5
    assert abs(mean_um - 1.6926 * sd_um) < 4 * 0.8884 * sd_um / 1000 ** 0.5, done.stdout
    pathlib.Path(folder, "empty.csv").write_text("machine,characteristic,value\n")
    assert run(EXAMPLES / "repeatability", "empty.csv", cwd=folder).returncode == 1


def test_location(folder):
    """L_Dia of five centres whose smallest sphere is known: it is held by two, three or four of them."""
    def points_csv(points):
        rows = ["machine,characteristic,value"]
        for i, j in itertools.combinations(range(5), 2):
            rows.append(f'0,"FA(S{i + 1}),FA(S{j + 1}),TA(C_{i + 1}{j + 1})",{math.dist(points[i], points[j])}')
        path = pathlib.Path(folder, "points.csv")
        path.write_text("\n".join(rows) + "\n")
        return path

    ball = [(0.003, 0, 0), (-0.001, 0.002, 0.002), (-0.001, -0.002, 0.002), (-0.001, 0, -math.sqrt(8) / 1000), (0.001, 0.0005, 0)]
    cases = ([(0, 0, 0), (0.006, 0, 0), (0.003, 0.001, 0), (0.002, 0, -0.001), (0.004, 0, 0.002)],  # two
             [(0.003 * math.cos(a), 0.003 * math.sin(a), 0) for a in (0, 2, 4)] + [(0, 0, 0.001), (0.001, 0, -0.001)],  # three
             ball)  # four, all 3 um from the origin
    for points in cases:
        done = run(EXAMPLES / "location", points_csv(points))
        assert done.returncode == 0 and "mean 6.000 " in done.stdout, (points, done)
    done = run(EXAMPLES / "location", points_csv([(0, 0, 0)] * 5))
    assert "mean 0.000 " in done.stdout, done
    # On a real run it lies between the largest distance and sqrt(3/2) of it (Jung 1901).
    values = samples(folder, "form_and_size_5x25.dmi", "coord3-mc16", 20)
    distances = [v for (name, _, _), v in values.items() if "TA(C_" in name]
    longest = 1e3 * sum(max(abs(v[i]) for v in distances) for i in range(20)) / 20
    mean = float(run(EXAMPLES / "location", pathlib.Path(folder, "samples.csv")).stdout.split("mean ")[1].split()[0])
    assert longest <= mean + 1e-3 and mean <= 1.2248 * longest, (longest, mean)
    assert run(EXAMPLES / "location", EXAMPLES / "e0.dmi").returncode == 1


def test_form(folder):
    """The median form of the program is that of the screening, but for the geometric errors across the sphere (under a tenth)."""
    values = samples(folder, "form_and_size_1x25.dmi", PORTAL, 1000)
    form = sorted(next(v for (name, _, _), v in values.items() if "TA(FORM)" in name))
    expected_um = next(c["median_um"] for c in screening(PORTAL)["probe"] if c["name"] == "P_Form.Sph.1x25")
    assert 0.97 < 1e3 * form[len(form) // 2] / expected_um < 1.1, (form[len(form) // 2], expected_um)


def test_generated(folder):
    assert run(EXAMPLES / "generate", folder).returncode == 0
    names = sorted(path.name for path in EXAMPLES.glob("*.dmi"))
    assert names == sorted(path.name for path in pathlib.Path(folder).glob("*.dmi")) and len(names) == 5
    for name in names:
        assert (EXAMPLES / name).read_text() == (pathlib.Path(folder) / name).read_text(), f"run examples/iso10360/generate: {name}"


def test_documented_commands(folder):
    """Every command of docs/acceptance_tests.md, in a folder that has the examples."""
    (pathlib.Path(folder) / "examples").symlink_to(ROOT / "examples")
    commands = [line.strip() for line in (ROOT / "docs" / "acceptance_tests.md").read_text().splitlines()
                if line.startswith("    ")]
    assert len(commands) >= 9
    for command in commands:
        words = shlex.split(command)
        done = run(ABBE if words[0] == "abbe" else words[0], *words[1:], cwd=folder)
        assert done.returncode == 0, (command, done)


for name, test in list(globals().items()):
    if name.startswith("test_"):
        with tempfile.TemporaryDirectory() as scratch:
            test(scratch) if test.__code__.co_argcount else test()
        print("ok", name)
