"""abbe diagnose --workpiece: what is known of the part."""
import json

import harness

BALL = harness.ROOT / "examples/programs/sphere_25_points.dmi"
MACHINE = harness.ROOT / "examples/iso10360/portal-2009.json"


def workpiece(surfaces=None, **more):
    return json.dumps({"schema": "abbe.workpiece/1", "name": "ball 12", "surfaces": surfaces or {}, **more})


def turned_plate():
    lines = ["DMISMN/'a plate turned on the table',5.2", "UNITS/MM,ANGDEC", "S(P)=SNSDEF/PROBE,INDEX,POL,0,0,0,0,-1,50,4", "SNSLCT/S(P)",
             "D(PLACE)=TRANS/XORIG,700,YORIG,500,ZORIG,-500", "D(TURNED)=ROTATE/ZAXIS,90"]

    def face(name, normal, points):
        at = ",".join(map(str, points[0]))
        lines.extend([f"F({name})=FEAT/PLANE,CART,{at},{normal}", f"MEAS/PLANE,F({name}),{len(points)}",
                      *(f"PTMEAS/CART,{x},{y},{z},{normal}" for x, y, z in points), "ENDMES"])

    face("TOP", "0,0,1", [(x, y, 0) for x in range(-150, 151, 50) for y in range(-90, 91, 60)])
    face("RIGHT", "1,0,0", [(152, y, z) for y in (-60, 60) for z in (-5, -15)])
    face("LEFT", "-1,0,0", [(-152, y, z) for y in (-60, 60) for z in (-5, -15)])
    face("FRONT", "0,-1,0", [(x, -92, z) for x in (-120, 120) for z in (-5, -15)])
    return "\n".join([*lines, "ENDFIL", ""])


class CalibratedPart(harness.Case):
    def record(self, *options, name="rec.csv", header=""):
        self.abbe("record", BALL, "--machine", MACHINE, "-o", name, *options)
        path = self.folder / name
        path.write_text(header + path.read_text())
        return path

    def diagnosis(self, *args):
        return json.loads(self.abbe("diagnose", *args, "--machine", MACHINE, "--format", "json").stdout)

    def test_a_calibrated_sphere_tells_a_tip_radius_from_its_size(self):
        recording = self.record("--with", "probe.tip_radius:amplitude_um=3", header="# surfaces: unknown_size\n")
        without = self.diagnosis(recording)
        self.assertEqual(without["verdict"], "no_mismatch")
        self.assertNotIn("probe.tip_radius", [d["effect"] for d in without["smallest_detectable"]])
        ball = self.write("ball.json", workpiece({"BALL": {"diameter_mm": {"value": 25.0, "u": 0.0001}}}))
        said = self.diagnosis(recording, "--workpiece", ball)
        self.assertNotEqual(said["verdict"], "no_mismatch")
        self.assertIn("probe.tip_radius", said["effects"][0]["members"])

    def test_a_warm_part_expands_from_the_point_that_is_touched_first(self):
        """From the machine's origin 345 ppm are a quarter of a millimetre: the targets were taken for those of another part."""
        program = harness.ROOT / "examples/programs/prismatic_part.dmi"
        warm = self.write("warm.json", workpiece(material={"cte_ppm_per_K": 23}, scales={"cte_ppm_per_K": 8},
                                                 temperature={"part_C": 35, "scale_C": 20}))
        self.abbe("record", program, "--machine", MACHINE, "--workpiece", warm, "-o", "warm.csv")
        said = self.diagnosis("warm.csv", "--program", program, "--workpiece", warm)
        named = self.write("named.dmi", program.read_text().replace("\n", "\n$$! workpiece warm.json\n", 1))
        self.assertEqual(self.diagnosis("warm.csv", "--program", named), said)
        self.assertEqual(said["verdict"], "no_mismatch")
        self.assertEqual([m["code"] for m in said["messages"] if m["code"] in ("W0704", "W0710")], [])

    def test_the_material_of_a_warm_part_is_asked_for_and_not_a_column_that_is_there(self):
        program = harness.ROOT / "examples/programs/prismatic_part.dmi"
        warm = self.write("warm.json", workpiece(material={"cte_ppm_per_K": 23}, temperature={"part_C": 25}))
        self.abbe("record", program, "--machine", MACHINE, "--workpiece", warm, "-o", "warm.csv")
        lines = (self.folder / "warm.csv").read_text().splitlines(keepends=True)
        self.write("untold.csv", "".join(line for line in lines if not line.startswith("# workpiece")))
        otherwise = self.diagnosis("untold.csv", "--program", program)["otherwise"]
        self.assertIn("The part was at 25.0 degrees C, and no workpiece file tells what it is made of: give one with --workpiece", otherwise)
        self.assertIn("Let temp_part_C vary", otherwise)
        self.assertNotIn("Log temp_part_C", otherwise)

    def test_a_certificate_is_asked_for_before_a_measurement(self):
        recording = self.record("--with", "probe.pretravel_lobing:amplitude_um=3", header="# surfaces: unknown_size\n")
        ball = self.write("ball.json", workpiece({"BALL": {"diameter_mm": {"value": 25.0, "u": 0.0001}}}))
        self.assertIn("give those of its certificate with --workpiece", self.diagnosis(recording)["otherwise"])
        self.assertNotIn("certificate", self.diagnosis(recording, "--workpiece", ball)["otherwise"] or "")

    def test_an_uncertain_size_explains_as_much_as_its_uncertainty(self):
        recording = self.record("--with", "probe.tip_radius:amplitude_um=3", header="# surfaces: unknown_size\n")
        ball = self.write("ball.json", workpiece({"ball": {"diameter_mm": {"value": 25.0, "u": 0.01}}}))
        self.assertEqual(self.diagnosis(recording, "--workpiece", ball)["verdict"], "no_mismatch")

    def test_a_ball_that_is_not_nominal_is_no_mismatch_once_it_is_calibrated(self):
        ball = self.write("ball.json", workpiece({"BALL": {"diameter_deviation_um": {"value": 8, "u": 0.1}}}))
        recorded = self.record("--workpiece", ball)                       # targets are those of the true ball, and the recording says so
        self.assertIn("# workpiece: ball 12", recorded.read_text())
        self.assertEqual(self.diagnosis(recorded, "--workpiece", ball)["verdict"], "no_mismatch")
        nominal = self.write("nominal.csv", "".join(line for line in self.on_nominal_targets(recorded)))
        self.assertNotEqual(self.diagnosis(nominal)["verdict"], "no_mismatch")
        self.assertEqual(self.diagnosis(nominal, "--workpiece", ball)["verdict"], "no_mismatch")
        other = self.write("other.json", workpiece().replace("ball 12", "ball 13"))
        self.refused("E0548", "diagnose", recorded, "--workpiece", other, "--machine", MACHINE)

    def on_nominal_targets(self, recording):
        """The same touches against the targets of the drawing."""
        drawn = [line.split(",") for line in self.record(name="drawn.csv").read_text().splitlines() if not line.startswith("#")]
        lines = [line for line in recording.read_text().splitlines() if not line.startswith("# workpiece")]
        at = [drawn[0].index(c) for c in ("tx", "ty", "tz")]
        rows = iter(drawn[1:])
        header = True
        for line in lines:
            fields = line.split(",")
            if not line.startswith("#") and not header:
                row = next(rows)
                for k in at:
                    fields[k] = row[k]
            header = header and line.startswith("#")
            yield ",".join(fields) + "\n"

    def test_a_warm_part_is_expected(self):
        warm = self.write("warm.json", workpiece(material={"name": "aluminium", "cte_ppm_per_K": 23}, temperature={"part_C": 26}))
        recording = self.record("--workpiece", warm)
        said = self.diagnosis(recording, "--workpiece", warm)
        self.assertEqual(said["verdict"], "no_mismatch")
        self.assertLess(self.diagnosis(recording)["rivals"]["chi2"]["p"], said["rivals"]["chi2"]["p"])

    def test_what_a_part_does_is_told_in_its_own_coordinates(self):
        """A plate that lies turned by a right angle: it bows along its own x, which is the machine's y. All of its top is one place of the scale of z."""
        plate = self.write("plate.dmi", turned_plate())
        self.abbe("record", plate, "--machine", MACHINE, "--with", "part.clamping:bow_um=20", "-o", "rec.csv")
        said = self.diagnosis("rec.csv", "--program", plate, "--model-out", "m.json")
        self.assertEqual(said["effects"][0]["members"], ["part.clamping"])
        settings, = json.loads((self.folder / "m.json").read_text())["effects"]
        bow, twist = (settings["parameters"][name] for name in ("bow_um", "twist_um"))
        self.assertLess(abs(bow["value"] - 20), 3 * bow["u"])
        self.assertGreater(bow["value"], 10 * bow["u"])
        self.assertLess(abs(twist["value"]), 3 * twist["u"])

    def test_a_form_of_one_kind_is_named(self):
        """A chuck of three jaws makes three lobes, and none of the other harmonics."""
        part = harness.ROOT / "examples/programs/prismatic_part.dmi"
        for seed in (1, 2, 3):
            self.abbe("record", part, "--machine", MACHINE, "--seed", seed, "--with", "part.form:three_lobe_um=4", "-o", "rec.csv")
            said = self.diagnosis("rec.csv", "--program", part)
            self.assertEqual(said["effects"][0]["members"], ["part.form"])
            lobes = said["effects"][0]["parameters"]["three_lobe_um"]
            self.assertLess(abs(lobes["value"] - 4), 3 * lobes["u"])
            self.assertIn("holds for no other part", said["effects"][0]["sentence"])

    def test_a_part_that_bends_between_two_runs_is_no_dirt(self):
        """By 20 um at two touches that are neighbours, in the one run and in the other."""
        part = harness.ROOT / "examples/programs/prismatic_part.dmi"
        self.abbe("record", part, "--machine", MACHINE, "--seed", 3, "-o", "before.csv")
        self.abbe("record", part, "--machine", MACHINE, "--seed", 3, "--run", 2, "--with", "part.clamping:bow_um=6,half_size_mm=80", "-o", "after.csv")
        said = self.diagnosis("before.csv", "after.csv", "--program", part)
        self.assertEqual((said["effects"][0]["members"], said["effects"][0]["new_in_run"]), (["part.clamping"], [2]))
        self.assertEqual(said["baseline"]["outliers"], [])

    def test_a_part_bends_about_a_plane_of_its_own(self):
        """Which is not where its touches have their middle: about that it would seem to stretch, as by a scale."""
        part = harness.ROOT / "examples/programs/prismatic_part.dmi"
        self.abbe("record", part, "--machine", MACHINE, "--seed", 3, "-o", "before.csv")
        self.abbe("record", part, "--machine", MACHINE, "--seed", 3, "--run", 2,
                  "--with", "part.clamping:bow_um=30,half_size_mm=80,neutral_mm=-25", "-o", "after.csv")
        said = self.diagnosis("before.csv", "after.csv", "--program", part)
        self.assertEqual((said["effects"][0]["members"], len(said["effects"])), (["part.clamping"], 1))
        low, high = said["effects"][0]["parameters"]["neutral_mm"]["interval95"]
        self.assertLess(low, -25)
        self.assertGreater(high, -25)

    def test_the_form_of_a_ball_that_is_measured_as_points_is_its_own(self):
        ball = harness.ROOT / "examples/iso10360/form_and_size_5x25.dmi"
        for run in (1, 2):
            self.abbe("record", ball, "--machine", MACHINE, "--seed", 7, "--run", run, "--with", "part.form:three_lobe_um=2", "-o", f"{run}.csv")
        said = self.diagnosis("1.csv", "2.csv")["effects"][0]
        self.assertIn("part.form", said["members"])
        form = next(m["parameters"] for m in said["by_member"] or [said] if "three_lobe_um" in m["parameters"])
        self.assertLess(abs(form["three_lobe_um"]["value"] - 2), 3 * form["three_lobe_um"]["u"])

    def test_a_force_that_fell_is_told_as_its_change(self):
        """A trigger force is never negative; its change is. Where both do the same to the touches, it is the change."""
        part = harness.ROOT / "examples/programs/prismatic_part.dmi"
        for change in (0.002, -0.002):
            self.abbe("record", part, "--machine", MACHINE, "--with", f"probe.stylus_bending:force_change_N={change}", "-o", "rec.csv")
            self.assertIn("probe.stylus_bending", self.diagnosis("rec.csv", "--program", part)["effects"][0]["members"], change)

    def test_a_program_in_machine_coordinates_has_its_part_in_the_middle_of_its_touches(self):
        """The machine's zero says nothing of the part: a clamp bows it about the same point with and without the program."""
        lengths = harness.ROOT / "examples/iso10360/e0.dmi"
        self.abbe("record", lengths, "--machine", "coord3-mc16", "--with", "part.clamping:bow_um=30", "-o", "rec.csv")
        for program in ([], ["--program", lengths]):
            said = json.loads(self.abbe("diagnose", "rec.csv", *program, "--machine", "coord3-mc16", "--format", "json").stdout)
            self.assertEqual(said["effects"][0]["members"], ["part.clamping"])
            bow = said["effects"][0]["parameters"]["bow_um"]
            self.assertLess(abs(bow["value"] - 30), 3 * bow["u"])
            self.assertGreater(bow["value"], 10 * bow["u"])

    def test_mistakes_in_the_workpiece_file(self):
        recording = self.record()
        wrong = self.write("wrong.json", workpiece({"BAL": {"offset_um": 1}}))
        self.assertIn("did you mean 'BALL'", self.refused("E0546", "diagnose", recording, "--workpiece", wrong, "--machine", MACHINE))
        flat = recording.read_text().splitlines()
        head = [k for k, line in enumerate(flat) if not line.startswith("#")][0]
        label, number, rest = flat[head + 1].split(",", 2)
        one_sided = self.write("one_sided.csv", "\n".join(flat[:head + 1] + [f"{label},{k},{rest}" for k in range(1, 15)]) + "\n")
        ball = self.write("ball.json", workpiece({"BALL": {"diameter_mm": 25}}))
        self.refused("E0547", "diagnose", one_sided, "--workpiece", ball, "--machine", MACHINE)
        for diameter, cause in ((25000, "micrometres"), (0.025, "metres"), (12.5, "radius")):
            wrong = self.write("wrong.json", workpiece({"BALL": {"diameter_mm": diameter}}))
            self.assertIn(cause, self.refused("E0701", "diagnose", recording, "--workpiece", wrong, "--machine", MACHINE))

    def test_a_form_is_left_out_aloud(self):
        ring = (harness.ROOT / "examples/programs/ring_gauge.dmi")
        self.abbe("record", ring, "--machine", "coord3-mc16", "-o", "ring.csv")
        feature = [line for line in (self.folder / "ring.csv").read_text().splitlines() if not line.startswith("#")][1].split(",")[0]
        part = self.write("ring.json", workpiece({feature: {"form": [{"undulations": 3, "amplitude_um": 1, "phase_deg": 0}]}}))
        self.assertIn("W0549", self.abbe("diagnose", "ring.csv", "--workpiece", part, "--machine", "coord3-mc16").stderr)

    def test_true_targets_may_hold_the_form(self):
        """The calibrated bore of docs/workpiece.md: its waves of known phase are in the targets that `record` writes."""
        ring = harness.ROOT / "examples/programs/ring_gauge.dmi"
        known, unknown = {"undulations": 3, "amplitude_um": 2, "phase_deg": 15}, {"undulations": 2, "amplitude_um": 1, "phase_deg": "random"}
        for waves, unused in (([known], False), ([known, unknown], True)):
            part = self.write("ring.json", workpiece({"BORE": {"diameter_mm": {"value": 50.0021, "u": 0.0004}, "form": waves}}))
            self.abbe("record", ring, "--machine", "coord3-mc16", "--workpiece", part, "-o", "ring.csv")
            told = self.abbe("diagnose", "ring.csv", "--workpiece", part, "--machine", "coord3-mc16", "--fail-on-mismatch").stderr
            self.assertEqual("W0549" in told, unused)


if __name__ == "__main__":
    harness.main()
