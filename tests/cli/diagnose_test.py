"""abbe diagnose: recordings against the machine that made them."""
import csv
import json
import pathlib
import random

import harness

PROGRAM = harness.ROOT / "examples/iso10360/form_and_size_5x25.dmi"   # one sphere, five orientations of the head, 125 touches
MACHINE = harness.ROOT / "examples/iso10360/portal-2009.json"

# Nine touches on either end of a bar of 500 mm along x, in the middle of the machine.
BAR = harness.LENGTH.split("F(A)=")[0] + "F(A)=FEAT/PLANE,CART,-400,0,0,-1,0,0\nF(B)=FEAT/PLANE,CART,100,0,0,1,0,0\n" + "".join(
    f"MEAS/PLANE,F({label}),9\n" + "".join(f"PTMEAS/CART,{x},{y},{z},{n},0,0\n" for y in (-20, 0, 20) for z in (-20, 0, 20)) + "ENDMES\n"
    for label, x, n in (("A", -400, -1), ("B", 100, 1))) + "ENDFIL\n"


class Diagnose(harness.Case):
    def record(self, *options, name="rec.csv", whole=False):
        """Of a part of PROGRAM, unless it is to be the whole."""
        self.abbe("record", PROGRAM if whole else self.sphere(), "--machine", MACHINE, "-o", name, *options)
        return self.folder / name

    def diagnosis(self, *args, code=0):
        return json.loads(self.abbe("diagnose", *args, "--machine", MACHINE, "--format", "json", code=code).stdout)

    def test_a_machine_in_order_agrees(self):
        said = self.diagnosis(self.record("--seed", 4))
        self.assertEqual(said["verdict"], "no_mismatch")
        self.assertGreater(said["p_value"], 0.01)
        self.assertEqual(said["effects"], [])
        self.assertTrue(said["smallest_detectable"])

    def test_an_effect_is_named_measured_and_modelled(self):
        recording = self.record("--with", "probe.pretravel_lobing:amplitude_um=3")
        said = self.diagnosis(recording, "--model-out", "improved.json", "--fail-on-mismatch", code=1)
        self.assertIn(said["verdict"], ("named", "one_of"))
        self.assertIn("probe.pretravel_lobing", said["effects"][0]["members"])
        self.assertLess(said["p_value"], 0.001)
        if said["effects"][0]["members"][0] == "probe.pretravel_lobing":
            low, high = said["effects"][0]["parameters"]["amplitude_um"]["interval95"]
            self.assertLess(low, 3.3)
            self.assertGreater(high, 2.7)
        # What the size comes to at the touches is the difference to the same recording without the effect.
        rows = lambda path: list(csv.DictReader(line for line in path.read_text().splitlines() if not line.startswith("#")))
        out = lambda row: sum(float(row[n]) * float(row[x]) for n, x in zip(("nx", "ny", "nz"), "xyz"))
        largest = 1000 * max(abs(out(a) - out(b)) for a, b in zip(rows(recording), rows(self.record(name="without.csv"))))
        self.assertAlmostEqual(said["effects"][0]["largest_um"], largest, delta=0.2 * largest)
        self.assertGreater(said["improvement"]["log_score_gain"], 3)
        self.assertLess(said["improvement"]["rms_um"]["after"], said["improvement"]["rms_um"]["before"])
        residuals = said["residuals"]
        self.assertEqual({len(column) for column in residuals.values()}, {said["touches"]})
        self.assertLess(sum(r * r for r in residuals["after_um"]), sum(r * r for r in residuals["before_um"]))
        # The machine file with the effect in it gives larger uncertainties than the one without.
        u = lambda machine: json.loads(self.abbe("run", self.sphere(), "--machine", machine, "--machines", 200, "--format", "json").stdout)["characteristics"][0]
        with_effect, without = u("improved.json"), u(MACHINE)
        self.assertNotEqual(with_effect["mean"], without["mean"])
        # And what was found is no mismatch any more for the machine as it is known now.
        again = self.diagnosis(recording, "--known", "improved.json")
        self.assertEqual(again["baseline"]["mode"], "known")

    def test_one_orientation_is_known_from_its_stylus(self):
        """Constant columns of the head say nothing that the stylus does not, and nothing lies in a head that stood still."""
        recording = self.record("--with", "probe.pretravel_lobing:amplitude_um=6")
        logged = self.changed(recording, lambda row: row if row["sensor"] == "H1" else None, "logged.csv")
        head = ("head_A_deg", "head_B_deg", "visit")
        known = self.changed(logged, lambda row: {k: v for k, v in row.items() if k not in head}, "known.csv")
        with_columns, without = self.diagnosis(logged), self.diagnosis(known)
        self.assertIn(with_columns["verdict"], ("named", "one_of"))
        for key in ("verdict", "p_value", "effects", "location", "cannot_judge"):
            self.assertEqual(with_columns[key], without[key], key)
        self.assertTrue(without["location"])
        self.assertFalse({"head", "sensor"} & {place["factor"] for place in without["location"]})

    def test_what_was_mended_leaves_the_machine_file(self):
        first = self.record("--with", "probe.tip_radius:amplitude_um=3")
        self.diagnosis(first, "--model-out", "worn.json")
        worn = json.loads((self.folder / "worn.json").read_text())
        self.assertEqual([e["name"] for e in worn["effects"]], ["probe.tip_radius"])
        second = self.record("--run", 2)
        self.assertIn("What is gone is in the machine file still: --model-out writes it without.",
                      self.abbe("diagnose", second, "--known", "worn.json").stdout)
        said = self.diagnosis(second, "--known", "worn.json", "--model-out", "mended.json")
        self.assertEqual(said["effects"][0]["members"][0], "probe.tip_radius")
        self.assertIn("not there any more", said["effects"][0]["sentence"])
        self.assertEqual(json.loads((self.folder / "mended.json").read_text())["effects"], [])
        # And what has grown is one effect, not two.
        self.diagnosis(self.record("--run", 3, "--with", "probe.tip_radius:amplitude_um=6"), "--known", "worn.json", "--model-out", "grown.json")
        grown = json.loads((self.folder / "grown.json").read_text())["effects"]
        self.assertEqual([e["name"] for e in grown], ["probe.tip_radius"])
        self.assertAlmostEqual(grown[0]["parameters"]["amplitude_um"]["value"], 6, delta=1)

    def test_lengths_beyond_the_specification_are_told(self):
        """A scale that is 28 um/m wrong where the MPE is 6 um, and a bar of 500 mm in one place: nothing to name it by."""
        program = self.write("bar.dmi", BAR)
        self.abbe("record", program, "--machine", MACHINE, "-o", "bar.csv", "--with", "machine.scale:scale_um_per_m=28,axis=x")
        said = self.diagnosis("bar.csv", "--fail-on-mismatch", code=1)
        self.assertEqual((said["verdict"], [m["code"] for m in said["messages"]]), ("no_mismatch", ["W0716"]))
        self.assertAlmostEqual(said["length_beyond_mpe"]["error_um"], 14, delta=3)
        self.assertIn("fails its acceptance test", self.abbe("diagnose", "bar.csv", "--machine", MACHINE).stdout)
        self.abbe("record", program, "--machine", MACHINE, "-o", "bar.csv")
        self.assertIsNone(self.diagnosis("bar.csv", "--fail-on-mismatch")["length_beyond_mpe"])

    def test_lengths_beyond_the_specification_are_told_beside_what_makes_none_of_them(self):
        program = self.write("bar.dmi", BAR)
        self.abbe("record", program, "--machine", MACHINE, "-o", "bar.csv", "--with", "machine.scale:scale_um_per_m=28,axis=x", "--with", "noise.vibration:sd_um=3")
        said = self.diagnosis("bar.csv")
        self.assertEqual(([e["members"] for e in said["effects"]], [m["code"] for m in said["messages"]]), ([["noise.vibration"]], ["W0716"]))

    def test_scatter_that_has_grown_is_one_effect(self):
        quiet = json.loads(MACHINE.read_text())
        quiet["effects"] = [{"name": "noise.vibration", "parameters": {"sd_um": {"value": 5, "u": 0.1}}}]
        self.write("quiet.json", json.dumps(quiet))
        recording = self.record("--with", "noise.vibration:sd_um=13", whole=True)
        said = json.loads(self.abbe("diagnose", recording, "--machine", "quiet.json", "--format", "json", "--model-out", "loud.json").stdout)
        self.assertIn("beside what the machine file has", said["effects"][-1]["sentence"])
        loud = json.loads((self.folder / "loud.json").read_text())["effects"]
        self.assertEqual([e["name"] for e in loud], ["noise.vibration"])
        self.assertAlmostEqual(loud[0]["parameters"]["sd_um"]["value"], 13, delta=2)   # 12 found beside 5

    def test_what_the_machine_file_scatters_and_rounds_is_no_mismatch(self):
        dirty = self.record("--with", "noise.outliers:share=0.05,size_um=30", name="dirty.csv")
        rounded = self.changed(self.record(), lambda row: row | {a: f"{float(row[a]):.3f}" for a in "xyz"} | {f"enc_{a}": "" for a in "xyz"})
        for recording, name in ((dirty, "noise.outliers"), (rounded, "noise.resolution")):
            first = json.loads(self.abbe("diagnose", recording, "--machine", MACHINE, "--model-out", "known.json", "--format", "json").stdout)
            self.assertEqual([e["members"] for e in first["effects"]], [[name]])
            again = json.loads(self.abbe("diagnose", recording, "--machine", "known.json", "--format", "json").stdout)
            self.assertEqual((again["verdict"], again["baseline"]["outliers"]), ("no_mismatch", first["baseline"]["outliers"]))

    def test_steps_of_all_positions_are_located_nowhere(self):
        lines = self.record().read_text().splitlines()
        start = next(k for k, line in enumerate(lines) if not line.startswith("#"))
        at = [lines[start].split(",").index(axis) for axis in "xyz"]
        rounded = [",".join(f"{float(v):.3f}" if k in at else v for k, v in enumerate(line.split(","))) for line in lines[start + 1:]]
        said = self.diagnosis(self.write("rounded.csv", "\n".join([*lines[:start + 1], *rounded]) + "\n"))
        self.assertIn("noise.resolution", [e["members"][0] for e in said["effects"]])
        self.assertEqual(said["location"], [])

    def test_noise_is_told_of_each_stylus(self):
        """A probe that scatters more along its axis: one stylus touched from the side, another from above."""
        machine = json.loads(self.abbe("machine", "init", "coord3-mc16").stdout)
        machine["probe"]["sd_um"] = [0.5, 0.5, 3]
        for name, length in ("SHORT", 100), ("LONG", 200):
            machine["sensors"][name] = next(iter(machine["sensors"].values())) | {"tip_in_r_mm": [0, 0, -length]}
        self.write("m.json", json.dumps(machine))
        draw = random.Random(2)
        lines = ["feature,touch,x,y,z,tx,ty,tz,nx,ny,nz,setup,run,sensor,time_s"]
        for stylus, sd_mm, normals in ("SHORT", 0.0005, [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)]), ("LONG", 0.003, [(0, 0, 1)]):
            for k in range(60):
                n, at, e = normals[k % len(normals)], (600 + k % 8 * 30, 400 + k // 8 * 30, -500), draw.gauss(0, sd_mm)
                fields = [stylus, k + 1, *(f"{c + e * u:.7f}" for c, u in zip(at, n)), *at, *n, 1, 1, stylus, 5 * len(lines)]
                lines.append(",".join(map(str, fields)))
        self.write("rec.csv", "\n".join(lines) + "\n")
        noise = json.loads(self.abbe("diagnose", "rec.csv", "--machine", "m.json", "--format", "json").stdout)["baseline"]["noise_by_sensor_um"]
        self.assertAlmostEqual(noise["SHORT"], 0.5, delta=0.2)
        self.assertAlmostEqual(noise["LONG"], 3, delta=1)

    def test_the_answer_does_not_depend_on_threads(self):
        recording = self.record("--with", "probe.tip_radius:amplitude_um=2")
        answers = [self.abbe("diagnose", recording, "--machine", MACHINE, "--format", "json", "--threads", t).stdout for t in (1, 2)]
        self.assertEqual(*answers)

    def test_text_is_for_people(self):
        text = self.abbe("diagnose", self.record("--with", "probe.tip_radius:amplitude_um=2"), "--machine", MACHINE).stdout
        self.assertIn("are not what", text.splitlines()[0])
        self.assertIn("On touches that the model had not seen", text)
        self.assertRegex(text, r"nats, standard error [0-9.]+; with the runner-up, [a-z._]+, [+-]")
        self.assertRegex(text, r"amplitude \d\.\d+ ± 0\.\d+ um")
        self.assertIn("what to do next:", text)
        self.assertNotIn("located in temperature", text)   # it was the same throughout

    def test_a_plan_tells_what_it_can_detect(self):
        said = self.diagnosis(self.record(), "--design-only")
        lobing = next(d for d in said["smallest_detectable"] if d["effect"] == "probe.pretravel_lobing")
        self.assertTrue(0.05 < lobing["detect_um"] < 3, lobing)
        self.assertEqual((said["effects"], said["verdict"], said["p_value"]), ([], None, None))
        self.assertIn("No value was looked at", self.abbe("diagnose", self.record(), "--machine", MACHINE, "--design-only").stdout)
        # What it could not tell apart comes with measurements that would, the best one as a program.
        self.assertGreaterEqual(len(said["next_measurement"]), 1)
        best = said["next_measurement"][0]
        self.assertGreaterEqual(len(best["separates"]), 2)
        self.assertTrue(0 < best["expected_probability"] <= 1, best)
        self.assertIn("ENDFIL", best["program"])

    def test_a_plan_needs_targets_only(self):
        """Before anything was measured there are no positions, and no readings, by which the phases of a scale would differ."""
        measured = self.changed(self.record(), lambda row: row | {"enc_" + a: "" for a in "xyz"}, "measured.csv")
        plan = self.changed(measured, lambda row: {key: value for key, value in row.items() if key not in ("x", "y", "z")}, "plan.csv")
        empty = self.changed(measured, lambda row: {**row, "x": "", "y": "", "z": ""}, "empty.csv")
        def told(path):
            return {d["effect"]: d["detect_um"] for d in self.diagnosis(path, "--design-only")["smallest_detectable"]}

        by_effect = told(measured)
        for planned in (told(plan), told(empty)):
            self.assertEqual(set(planned), set(by_effect))
            for effect, um in by_effect.items():
                self.assertAlmostEqual(planned[effect] / um, 1)
        self.assertIn("--design-only", self.refused("E0528", "diagnose", empty, "--machine", MACHINE))

    def test_values_of_a_list_that_fit_as_well_are_told(self):
        """Nodes every 50 mm were told as nodes every 25 mm for certain."""
        recording = self.record("--seed", 3, "--with", "machine.map_scallops:amplitude_um=4,spacing_mm=50", whole=True)
        spacing = self.diagnosis(recording)["effects"][0]["parameters"]["spacing_mm"]
        others = {other["value"]: other["probability"] for other in spacing["others"]}
        self.assertEqual({f"{spacing['value']:g} mm", *others} & {"25 mm", "50 mm"}, {"25 mm", "50 mm"})
        self.assertTrue(all(0.05 <= p <= 0.95 for p in (spacing["probability"], *others.values())), spacing)
        self.assertLess(spacing["probability"] + sum(others.values()), 1 + 1e-9)

    def test_a_missing_covariate_is_named(self):
        def without_speed(row):
            del row["speed_mm_s"]
            return row
        said = self.diagnosis(self.changed(self.record(), without_speed))
        entry = next(c for c in said["cannot_judge"] if c["effect"] == "probe.trigger_delay")
        self.assertEqual(entry["missing"], ["speed_mm_s"])

    def test_a_name_that_cannot_be_judged_is_believed_by_half(self):
        def without_clock(row):
            del row["time_s"]
            return row
        shifted = self.record("--with", "part.shift:amplitude_um=12,t0_s=100,direction=x", whole=True)
        said = self.diagnosis(self.changed(shifted, without_clock))
        self.assertEqual(said["verdict"], "cannot_judge")
        self.assertEqual(said["effects"][0]["probability"], 0.5)
        self.assertIn("Log time_s", said["otherwise"])
        self.assertEqual(said["location"][0]["factor"], "time")
        self.assertNotIn("time_s", said["location"][0]["where"], "nobody logged seconds")

    def test_targets_may_come_from_the_program(self):
        def bare(row):
            return {k: row[k] for k in ("feature", "touch", "x", "y", "z")}
        bare_recording = self.changed(self.record("--with", "probe.tip_radius:amplitude_um=3"), bare)
        said = self.diagnosis(bare_recording, "--program", self.sphere())
        self.assertNotEqual(said["verdict"], "no_mismatch")
        self.refused("E0543", "diagnose", bare_recording, "--machine", MACHINE)

        def renamed(row):
            return bare(row) | {"feature": "ELSEWHERE"}
        self.refused("E0544", "diagnose", self.changed(self.record(), renamed), "--program", self.sphere(), "--machine", MACHINE)
        other = self.changed(self.record(), lambda row: row | {"feature": "ELSEWHERE"})   # with targets of its own
        self.assertIn("or none", self.refused("E0544", "diagnose", other, "--program", self.sphere(), "--machine", MACHINE))

    def test_data_problems_are_recognised(self):
        recording = self.record()

        def scaled(by):
            return lambda row: row | {a: repr(by * float(row[a])) for a in "xyz"}

        def swapped(row):
            return row | {"x": row["y"], "y": row["x"]}

        def inside_out(row):
            return row | {"n" + a: repr(-float(row["n" + a])) for a in "xyz"}

        def without_radius(row):
            return row | {a: repr(float(row[a]) - 2 * float(row["n" + a])) for a in "xyz"}
        for what, change in (("metres", scaled(1e-3)), ("swapped", swapped), ("tip radius", without_radius), ("normals", inside_out)):
            message = self.refused("E0701", "diagnose", self.changed(recording, change), "--machine", MACHINE)
            self.assertIn(what, message)
        rows = recording.read_text().splitlines()
        twice = self.write("twice.csv", "\n".join(rows + rows[-3:]) + "\n")
        self.assertIn("W0702", self.abbe("diagnose", twice, "--machine", MACHINE).stderr)

    def test_a_real_part_is_compared_with_itself(self):
        """Surfaces far from their targets: only what repeats differently is judged."""
        offset = lambda row: row | {"z": repr(float(row["z"]) + 0.8 * float(row["nz"]) + 0.9 * float(row["ny"]) ** 2)}
        done = self.abbe("diagnose", self.changed(self.record(), offset), "--machine", MACHINE)
        self.assertIn("W0704", done.stderr)
        bad = self.write("bad.csv", "# surfaces: perhaps\n" + self.record().read_text())
        self.refused("E0703", "diagnose", bad, "--machine", MACHINE)

    def test_bad_recordings(self):
        head = "feature,touch,x,y,z,tx,ty,tz,nx,ny,nz\n"
        row = "A,1,0,0,0,0,0,0,0,0,1\n"
        for code, text in {"E0521": head + '"A,1,0,0,0,0,0,0,0,0,1\n', "E0522": "feature,touch,x,y,z,x\n", "E0523": head + "A,1,0\n", "E0524": "# nothing\n",
                           "E0525": "# frame: there\n" + head + row, "E0526": "feature,touch,x,y,z,tempp_part_C\nA,1,0,0,0,20\n",
                           "E0527": "feature,x,y,z\nA,0,0,0\n", "E0528": head + "A,1,0,0,,0,0,0,0,0,1\n", "E0529": head + "A,1,0,0,0,0,0,0,0,0,3\n",
                           "E0530": head + "A,one,0,0,0,0,0,0,0,0,1\n", "E0705": head + row}.items():
            self.refused(code, "diagnose", self.write("bad.csv", text), "--machine", MACHINE)
        self.assertIn("the header is missing", self.refused("E0524", "diagnose", self.write("bad.csv", row + row), "--machine", MACHINE))
        self.assertIn("or one at the end of the line", self.refused("E0526", "diagnose", self.write("bad.csv", "feature,touch,x,y,z,\nA,1,0,0,0,\n"), "--machine", MACHINE))
        with_unit = self.write("bad.csv", "feature,touch,x_mm,y,z\nA,1,0,0,0\n")
        self.assertIn("did you mean 'x'?", self.refused("E0526", "diagnose", with_unit, "--machine", MACHINE))

        many = head + "".join(f"A,{k},0,0,0,0,0,0,0,0,1\n" for k in range(1, 4002))
        self.assertIn("leave out repeats", self.refused("E0719", "diagnose", self.write("many.csv", many), "--machine", MACHINE))
        sensor = self.record().read_text().replace("# sensor H1: head_deg", "# sensor H1: head_degrees")
        self.refused("E0545", "diagnose", self.write("bad.csv", sensor), "--machine", MACHINE)

    def test_recordings_that_cannot_be_joined(self):
        one = self.record()
        other = self.write("other.csv", one.read_text().replace("# point: tip_centre", "# point: surface"))
        self.refused("E0707", "diagnose", one, other, "--machine", MACHINE)
        for surfaces in ("calibrated", "unknown_size"):
            self.write(f"{surfaces}.csv", f"# surfaces: {surfaces}\n" + one.read_text())
        said = self.refused("E0707", "diagnose", "calibrated.csv", "unknown_size.csv", "--machine", MACHINE)
        self.assertIn("'# surfaces:' says calibrated in 'calibrated.csv' and unknown_size in 'unknown_size.csv'", said)

    def test_one_name_of_two_styli_is_refused(self):
        one = self.record("--seed", 1)
        again = self.record("--seed", 1, "--run", 2, name="again.csv").read_text()
        requalified = self.write("requalified.csv", again.replace("# sensor H1: head_deg 0 0 tip_in_r_mm 0.0", "# sensor H1: head_deg 0 0 tip_in_r_mm 0.1"))
        other = self.write("other.csv", again.replace("# sensor H1: head_deg 0 0 ", "# sensor H1: head_deg 15 0 "))
        self.abbe("diagnose", one, requalified, "--machine", MACHINE, "--design-only")
        self.refused("E0707", "diagnose", one, other, "--machine", MACHINE)

    def test_what_a_recording_does_not_say_is_assumed_aloud(self):
        def nameless(row):
            for key in ("sensor", "head_A_deg", "head_B_deg", "visit"):
                del row[key]
            for a in ("x", "tx"):
                row[a] = repr(float(row[a]) + 5000)
            return row
        done = self.abbe("diagnose", self.changed(self.record(), nameless), "--machine", MACHINE)
        self.assertIn("W0541", done.stderr)
        self.assertIn("W0542", done.stderr)

    def test_part_coordinates_are_doubted_aloud(self):
        recording = self.record("--seed", 4)
        self.assertNotIn("W0558", self.abbe("diagnose", recording, "--machine", MACHINE, "--design-only").stderr)
        recording.write_text(recording.read_text().replace("# frame: mcs", "# frame: part"))
        self.assertIn("W0558", self.abbe("diagnose", recording, "--machine", MACHINE, "--design-only").stderr)

    def test_a_broken_known_state_is_refused(self):
        machine = json.loads(MACHINE.read_text())
        recording = self.record()
        good = {"schema": "abbe.known_state/1", "mean": [0] * 378, "factor": [[0] * 378]}
        self.write("length.dmi", harness.LENGTH)
        for state, code in (({"a": 1}, "E0402"), (good | {"means": 1}, "E0402"), ({"schema": None}, "E0405"), ([], "E0405"), (7, "E0405"),
                            (good | {"schema": "abbe.known_state/2"}, "E0407"), (good | {"mean": [1, 2]}, "E0706"), (good | {"factor": [[0]]}, "E0706"),
                            (good | {"factor": [1]}, "E0405"), ({k: v for k, v in good.items() if k != "factor"}, "E0404")):
            machine["known_state"] = state
            path = self.write("known.json", json.dumps(machine))
            self.refused(code, "diagnose", recording, "--known", path)
            self.refused(code, "machine", "show", path)   # no command takes a file that says nothing known
            self.refused(code, "run", "length.dmi", "--machine", path)


if __name__ == "__main__":
    harness.main()
