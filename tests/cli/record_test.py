"""abbe record: one machine's recording as CSV."""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ABBE = sys.argv[1]
ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "examples/programs/sphere_25_points.dmi"
failures = []


def check(condition, what):
    print(("ok    " if condition else "FAIL  ") + what)
    if not condition:
        failures.append(what)


def record(folder, *args):
    out = pathlib.Path(folder) / "rec.csv"
    run = subprocess.run([ABBE, "record", str(PROGRAM), "-o", str(out), *args], capture_output=True, text=True)
    return run, out


def rows(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def normal_error_um(row):
    return 1000 * sum((float(row[a]) - float(row["t" + a])) * float(row["n" + a]) for a in "xyz")


with tempfile.TemporaryDirectory() as folder:
    run, out = record(folder)
    check(run.returncode == 0 and run.stdout == "", "writes the file and nothing on stdout")
    plain = rows(out)
    check(len(plain) == 25, "one row a touch")
    check(plain[3]["feature"] == "BALL" and plain[3]["touch"] == "4", "feature and 1-based touch")
    check(all(c in plain[0] for c in ("time_s", "speed_mm_s", "accel_mm_s2", "ax", "enc_x", "head_A_deg", "visit", "sensor")), "covariates are there")
    check(float(plain[-1]["time_s"]) > float(plain[0]["time_s"]) > 0, "time goes on")
    check(max(abs(normal_error_um(r)) for r in plain) < 30, "errors along the normal are those of a machine in order")
    check("temp_part_C" not in plain[0], "what is not known is not a column")

    run, out = record(folder, "--with", "probe.tip_radius:amplitude_um=2")
    larger = rows(out)
    difference = [normal_error_um(b) - normal_error_um(a) for a, b in zip(plain, larger)]
    check(all(abs(d - 2) < 0.002 for d in difference), "a tip larger by 2 um reads +2 um everywhere, all else equal")

    run, out = record(folder, "--run", "2")
    again = rows(out)
    repeats = [normal_error_um(b) - normal_error_um(a) for a, b in zip(plain, again)]
    run, out = record(folder, "--seed", "2")
    elsewhere = [normal_error_um(b) - normal_error_um(a) for a, b in zip(plain, rows(out))]
    check({r["run"] for r in plain} == {"1"} and {r["run"] for r in again} == {"2"}, "a repeat says that it is one")
    check(all(repeats) and max(map(abs, repeats)) < max(map(abs, elsewhere)) / 2, "it has other noise, but not another machine")
    visits = [{r["visit"] for r in recorded} for recorded in (plain, again, rows(record(folder, "--run", "1000000")[1]))]
    check(visits == [{"1"}, {"2"}, {"1000000"}], "the head is indexed anew in each run, and visits count on")
    check(record(folder, "--run", "0")[0].returncode == 2, "runs begin with 1")

    run, out = record(folder, "--setup", "2")
    placed = rows(out)
    check({r["setup"] for r in plain} == {"1"} and {r["setup"] for r in placed} == {"2"}, "a placement of the part has its number")
    anew = [normal_error_um(b) - normal_error_um(a) for a, b in zip(plain, placed)]
    check(all(anew) and max(map(abs, anew)) < max(map(abs, elsewhere)) / 2, "and other noise, but not another machine")
    run, out = record(folder, "--setup", "2", "--run", "2")
    check(all(normal_error_um(a) != normal_error_um(b) for a, b in zip(rows(out), again)), "in every run")
    run, out = record(folder, "--setup", "2")
    check(record(folder, "--setup", "0")[0].returncode == 2, "setups begin with 1")
    said = dict(line[2:].split(": ", 1) for line in out.read_text().splitlines() if line.startswith("# "))
    check((said["approach_mm"], said["retract_mm"]) == ("3", "3"), "what SNSET said")
    check("temperature_compensation" not in said, "without a workpiece nothing is compensated")
    varied = pathlib.Path(folder) / "varied.dmi"
    text = PROGRAM.read_text()
    varied.write_text(text.replace("seed 1\n", "seed 2\n"))
    done = subprocess.run([ABBE, "record", str(varied), "-o", str(out)], capture_output=True, text=True)
    seeded = [normal_error_um(b) - normal_error_um(a) for a, b in zip(plain, rows(out))]
    check(done.returncode == 0 and seeded == elsewhere, "the seed of the program chooses the machine too")
    varied.write_text(text[:text.rindex("PTMEAS")] + "SNSET/APPRCH,2.5\n" + text[text.rindex("PTMEAS"):])
    done = subprocess.run([ABBE, "record", str(varied), "-o", str(out)], capture_output=True, text=True)
    check(done.returncode == 0 and "# approach_mm" not in out.read_text() and "# retract_mm: 3" in out.read_text(), "what changed is not said")

    run, out = record(folder, "--with", "machine.scale:axis=x,scale_um_per_m=10")
    check(run.returncode == 0, "a choice may be given by its word")

    run, out = record(folder, "--with", "probe.tip_radius")
    check(run.returncode == 0 and rows(out) != plain, "an effect without parameters acts with its typical size")

    run, out = record(folder, "--with", "thermal.part_expansion", "--with", "machine.scale")
    check(run.returncode == 0 and "W0615" in run.stderr and "thermal.part_expansion" in run.stderr, "an expansion at 20 degrees C does nothing, and that is said")
    check("machine.scale" not in run.stderr, "nothing is said of what does something")

    run, out = record(folder, "--seed", "21", "--with", "noise.outliers:share=0.0001")
    check("W0615" in run.stderr and "another --seed" in run.stderr, "dirt that did not come is no effect without an effect")

    for idle, size in (("noise.outliers:size_um=5", "share=0.005"), ("machine.scale:axis=y", "scale_um_per_m=5"), ("noise.resolution:resolution_um=0", "resolution_um=0.5")):
        run, out = record(folder, "--with", idle)
        check("W0615" in run.stderr and f"is 0: give it a size, such as {size}" in run.stderr, f"{idle} has no size, and that is the reason told")
    run, out = record(folder, "--with", "machine.step:amplitude_um=2,along=x,position_mm=800")
    check(run.returncode == 0 and rows(out) != plain, "a position counts along an axis")
    run, out = record(folder, "--with", "thermal.drift:amplitude_um=3,direction=oblique,azimuth_deg=30")
    check(run.returncode == 0 and run.stderr == "", "an azimuth counts in an oblique direction")

    # Who reads a recording sees which effects were at work, and every row that was written.
    init = json.loads(subprocess.run([ABBE, "machine", "init", "worn"], capture_output=True, text=True).stdout)
    init["effects"] = [{"name": "probe.tip_radius", "parameters": {"amplitude_um": 3}}]
    (pathlib.Path(folder) / "worn.json").write_text(json.dumps(init))
    run, out = record(folder, "--machine", str(pathlib.Path(folder) / "worn.json"), "--with", "machine.scale")
    check("# effects: probe.tip_radius (machine file) machine.scale\n" in out.read_text(), "effects of the machine file are listed too")
    hashed = pathlib.Path(folder) / "hashed.dmi"
    hashed.write_text(PROGRAM.read_text().replace("F(BALL)", "F(#BALL)").replace("FA(BALL)", "FA(#BALL)"))
    subprocess.run([ABBE, "record", str(hashed), "-o", str(out)], capture_output=True, text=True)
    done = subprocess.run([ABBE, "diagnose", str(out), "--machine", "coord3-mc16", "--format", "json"], capture_output=True, text=True)
    check(done.returncode == 0 and json.loads(done.stdout)["touches"] == 25, "a label that begins like a comment is read back")

    # Every effect that `abbe explain` lists, with its first parameter in the middle of its range.
    def explained(*words):
        return subprocess.run([ABBE, "explain", *words], capture_output=True, text=True).stdout.splitlines()

    names = [line.split()[0] for line in explained() if re.match(r"  [a-z]+\.[a-z_]+ ", line)]
    check(len(names) > 30, f"{len(names)} effects are listed")
    for name in names:
        parameter, low, high = next(m.groups() for m in map(re.compile(r"  (\w+) \[.*; (\S+) to (\S+)$").match, explained(name)) if m)
        run, out = record(folder, "--with", f"{name}:{parameter}={(float(low) + float(high)) / 2:g}")
        check(run.returncode == 0 and len(rows(out)) == 25, f"{name}:{parameter}")

    # The result file is that of the recorded machine: a tip larger by 2 um makes its sphere larger by 4 um.
    def diameter(*arguments):
        dmo = pathlib.Path(folder) / "rec.dmo"
        run, out = record(folder, "--dmo", str(dmo), *arguments)
        check(run.returncode == 0, "--dmo: " + " ".join(arguments))
        (line,) = (line for line in dmo.read_text().splitlines() if line.startswith("FA(BALL) = FEAT/SPHERE"))
        return float(line.split(",")[-1])

    check(abs(diameter("--with", "probe.tip_radius:amplitude_um=2") - diameter() - 0.004) < 2e-5, "the result file has the errors of the machine")
    check(diameter() != diameter("--seed", "2"), "another seed is another machine")

    # What is rounded falls on a grid, and the result file is made of it.
    def off_grid(values, step_mm):
        return max(abs(v / step_mm - round(v / step_mm)) for v in values)

    rounding = ("--with", "noise.resolution:resolution_um=10", "--dmo", str(pathlib.Path(folder) / "rec.dmo"))
    run, out = record(folder, *rounding)
    rounded = rows(out)
    check(run.returncode == 0 and run.stderr == "", "rounding is an effect that does something")
    written = [float(r[c]) for r in rounded for c in ("x", "y", "z", "enc_x", "enc_y", "enc_z")]
    check(off_grid(written, 0.01) < 1e-6, "positions and scale readings are multiples of the step")
    check(all(abs(float(a[c]) - float(b[c])) <= 0.00500001 for a, b in zip(plain, rounded) for c in "xyz"), "the nearest ones")
    made = subprocess.run([ABBE, "run", str(PROGRAM), "--recording", str(out), "--machines", "2", "--dmo", str(pathlib.Path(folder) / "of_points.dmo")], capture_output=True, text=True)
    results = [[line for line in (pathlib.Path(folder) / name).read_text().splitlines() if not line.startswith("$$!")] for name in ("rec.dmo", "of_points.dmo")]
    check(made.returncode == 0 and results[0] == results[1], "the result file is that of the rounded points")
    worn = json.loads((pathlib.Path(folder) / "worn.json").read_text())
    worn["effects"] = [{"name": "noise.resolution", "parameters": {"resolution_um": {"value": 4, "u": 0.1}}}]
    (pathlib.Path(folder) / "worn.json").write_text(json.dumps(worn))
    run, out = record(folder, "--machine", str(pathlib.Path(folder) / "worn.json"))
    check(off_grid([float(r[c]) for r in rows(out) for c in "xyz"], 0.004) < 1e-6, "the machine file rounds, too")
    run, out = record(folder, "--with", "noise.resolution:resolution_um=0")
    check("W0615" in run.stderr, "no step is no effect")

    # What a run warns of holds for a recording, too.
    suspect = pathlib.Path(folder) / "suspect.dmi"
    suspect.write_text(
        "DMISMN/'suspect',4.0\nUNITS/MM,ANGDEC\nPRCOMP/ON\nSNSLCT/SA(A0B0)\nF(P)=FEAT/POINT,CART,800,500,200,0,0,1\n"
        "GOTO/CART,5000,500,300\nMEAS/POINT,F(P),1\nPTMEAS/CART,800,500,200,0,0,1\nENDMES\nENDFIL\n")
    nowhere = json.loads(subprocess.run([ABBE, "machine", "init", "nowhere"], capture_output=True, text=True).stdout)
    del nowhere["offsets_mm"]
    (pathlib.Path(folder) / "nowhere.json").write_text(json.dumps(nowhere))
    done = subprocess.run([ABBE, "record", str(suspect), "--machine", str(pathlib.Path(folder) / "nowhere.json"), "-o", str(out)], capture_output=True, text=True)
    for code, what in (("W0303", "shifted"), ("W0309", "outside the travel"), ("W0417", "no scale position")):
        check(done.returncode == 0 and done.stderr.count(code) == 1 and what in done.stderr, f"{code} is said once")

    # Several outputs are written all or none; a folder is refused before the work.
    for arguments, text in ((["--dmo", "/dev/full"], "/dev/full"), (["--dmo", folder], "is a folder"), (["--dmo", "/proc/none.dmo"], "/proc/none.dmo")):
        (pathlib.Path(folder) / "rec.csv").unlink(missing_ok=True)
        run, out = record(folder, *arguments)
        check(run.returncode == 2 and "E0602" in run.stderr and text in run.stderr and not out.exists(), f"{' '.join(arguments)}: nothing is written")

    for arguments, code, text in ((["--with", "probe.tip_radus"], "E0305", "did you mean 'probe.tip_radius'"),
                                  (["--with", "pretravel_lobing"], "E0305", "did you mean 'probe.pretravel_lobing'?"),
                                  (["--with", "pretravel_lobbing"], "E0305", "did you mean 'probe.pretravel_lobing'?"),
                                  (["--with", "noise.resolution:resolution_um=1000"], "E0307", "not plausible"),
                                  (["--with", "probe.tip_radius:amplitude=1"], "E0306", "did you mean 'amplitude_um'?"),
                                  (["--with", "probe.tip_radius:amplitude_um=1e9"], "E0307", "not plausible"),
                                  (["--with", "probe.tip_radius:amplitude_um=nan"], "E0307", "nan"),
                                  (["--with", "probe.step:amplitude_um=5,tip=every"], "E0307", "give all, or a whole number from 0 to 1000"),
                                  (["--with", "machine.scale:axis=q"], "E0307", "x, y, z"),
                                  (["--with", "noise.outliers:share=2"], "E0307", "a number from 0 to 0.5\n"),
                                  (["--with", "machine.scale_interpolation:amplitude_um=5"], "E0307", "read backwards"),
                                  (["--with", "empirical.curve:from=3,to=3,x0_um=1"], "E0307", "two ends"),
                                  (["--with", "thermal.drift:amplitude_um=3,azimuth_deg=30"], "E0307", "add direction=oblique"),
                                  (["--with", "machine.step:amplitude_um=2,position_mm=800"], "E0307", "says nothing with along=time"),
                                  (["--with", "machine.step:amplitude_um=2,along=x,t0_s=60"], "E0307", "add along=time"),
                                  (["--with", "thermal.part_soak:start_K=1,shift_y_um=2"], "E0307", "add held=elsewhere"),
                                  (["--with", "noise.unequal:ratio=2,faster_than_mm_s=3"], "E0307", "add group=fast probing"),
                                  (["--with", "machine.scal"], "E0305", "--with machine.scal:"),
                                  (["--with", "machine.scale:axis=x,axis=y"], "E0610", "twice"),
                                  (["--with", "probe.tip_radius:amplitude_um"], "E0610", "parameter=value")):
        (pathlib.Path(folder) / "rec.csv").unlink(missing_ok=True)
        run, out = record(folder, *arguments)
        check(run.returncode == 2 and code in run.stderr and text in run.stderr, f"{' '.join(arguments)}: {code}")
        check(not out.exists(), "nothing is written then")

with tempfile.TemporaryDirectory() as folder:
    steps = [rows(record(folder, "--with", f"probe.step:amplitude_um=5,t0_s=5,tip={tip}")[1]) for tip in ("0", "all")]
    check(steps[0] == steps[1], "tip=all, as a diagnosis tells it, is tip=0")

with tempfile.TemporaryDirectory() as folder:
    PROGRAM = ROOT / "examples/programs/prismatic_part.dmi"
    run, out = record(folder, "--seed", "3")
    quiet = rows(out)
    features = list(dict.fromkeys(row["feature"] for row in quiet))
    run, out = record(folder, "--seed", "3", "--with", "noise.unequal:ratio=5,group=one feature,feature=3")
    moved = {row["feature"] for row, before in zip(rows(out), quiet) if [row[a] for a in "xyz"] != [before[a] for a in "xyz"]}
    # those after it are measured in coordinates that it has a share in
    check(moved.isdisjoint(features[:2]) and features[2] in moved, "features count in the order of their first touches")

sys.exit(1 if failures else 0)
