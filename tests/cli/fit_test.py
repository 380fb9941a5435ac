"""abbe fit, from the command line. usage: fit_test.py ABBE"""
import json
import pathlib
import subprocess
import sys
import tempfile

ABBE = sys.argv[1]
CASES = pathlib.Path(__file__).resolve().parents[1] / "reference" / "fits"
KEYS = {
    "line": ["point", "direction"],
    "plane": ["point", "normal"],
    "circle": ["center", "normal", "radius"],
    "sphere": ["center", "radius"],
    "cylinder": ["point", "axis", "radius"],
    "cone": ["point", "axis", "half_angle_deg", "radius", "apex"],
    "torus": ["center", "axis", "major_radius", "minor_radius"],
}


def fit(folder, element, points, *options):
    csv = pathlib.Path(folder) / "points.csv"
    csv.write_text("x,y,z\n" + "".join(",".join(str(c) for c in p) + "\n" for p in points))
    return subprocess.run([ABBE, "fit", element, str(csv), *options], capture_output=True, text=True)


def check_case(folder, path):
    case = json.loads(path.read_text())
    element, options = case["element"], ["--format", "json"]
    if "normal" in case["given"]:
        options += ["--normal", ",".join(str(c) for c in case["given"]["normal"])]
    done = fit(folder, element, case["points"], *options)
    if "expected_error" in case:
        assert done.returncode == 2 and done.stdout == "", done
        assert "E0505" in done.stderr and case["expected_error"] in done.stderr, done.stderr
        return
    assert done.returncode == 0 and done.stderr == "", done
    result = json.loads(done.stdout)
    assert result["schema"] == "abbe.fit/1" and result["element"] == element
    assert result["n"] == len(case["points"])
    for key in KEYS[element] + ["rms", "form"]:
        expected, actual = case["expected"][key], result[key]
        pairs = zip(expected, actual) if isinstance(expected, list) else [(expected, actual)]
        assert all(abs(a - b) <= 1e-7 for a, b in pairs), (key, expected, actual)


def check_refusals(folder):
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.5]]
    done = fit(folder, "shpere", points)
    assert done.returncode == 2 and "E0504" in done.stderr and "'sphere'" in done.stderr, done
    done = fit(folder, "plane", points, "--normal", "0,0,1")
    assert done.returncode == 2 and "E0506" in done.stderr and done.stdout == "", done
    done = fit(folder, "cone", points)
    assert done.returncode == 2 and "E0505" in done.stderr and "at least 6" in done.stderr, done
    done = fit(folder, "sphere", [["1", "2", "3,4"]])
    assert done.returncode == 2 and "points.csv:2:1: error E0502" in done.stderr, done
    done = fit(folder, "plane", [*points, [0, "nan", 1]])
    assert done.returncode == 2 and "points.csv:6:1: error E0505" in done.stderr, done


with tempfile.TemporaryDirectory() as temporary:
    cases = sorted(CASES.glob("*.json"))
    assert cases
    for case_path in cases:
        try:
            check_case(temporary, case_path)
        except AssertionError as failure:
            sys.exit(f"{case_path.name}: {failure}")
    check_refusals(temporary)
    text = fit(temporary, "PLANE", [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "--format", "text").stdout
    assert "normal" in text and "1.000000000" in text, text
