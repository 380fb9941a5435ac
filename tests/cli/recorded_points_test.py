"""abbe run --recording: errors added to recorded points instead of to nominal ones."""
import json

import harness

PROGRAM = harness.ROOT / "examples/programs/sphere_25_points.dmi"


class RecordedPoints(harness.Case):
    def size(self, *options):
        report = json.loads(self.abbe("run", PROGRAM, "--machines", 300, "--format", "json", *options).stdout)
        return report, next(c for c in report["characteristics"] if c["kind"] == "DIAM")

    def test_the_reference_is_what_the_recorded_points_give(self):
        self.abbe("record", PROGRAM, "-o", "plain.csv")
        self.abbe("record", PROGRAM, "-o", "rec.csv", "--with", "probe.tip_radius:amplitude_um=50")
        report, recorded = self.size("--recording", "rec.csv")
        _, plain = self.size("--recording", "plain.csv")
        nominal_report, nominal = self.size()
        self.assertEqual(report["errors_added_to"], "recorded points")
        self.assertEqual(nominal_report["errors_added_to"], "nominal points")
        # A tip larger by 50 um makes the ball larger by 100 um, whatever else that machine did to the points.
        self.assertAlmostEqual(recorded["reference"] - plain["reference"], 0.1, delta=1e-5)
        # The errors that are added are the same: to first order so is the uncertainty.
        self.assertAlmostEqual(recorded["u"] / nominal["u"], 1, delta=0.01)

    def test_every_touch_must_be_recorded(self):
        self.abbe("record", PROGRAM, "-o", "rec.csv")
        lines = (self.folder / "rec.csv").read_text().splitlines()
        self.write("short.csv", "\n".join(lines[:-1]) + "\n")
        self.assertIn("no touch 25 of 'BALL'", self.refused("E0304", "run", PROGRAM, "--recording", "short.csv"))

    def test_points_in_part_coordinates_are_no_points_of_the_machine(self):
        self.abbe("record", PROGRAM, "-o", "rec.csv")
        text = (self.folder / "rec.csv").read_text()
        self.assertIn("# frame: mcs\n", text)
        self.write("part.csv", text.replace("# frame: mcs\n", "# frame: part\n"))
        self.assertIn("part.csv: its points are in part coordinates", self.refused("E0525", "run", PROGRAM, "--recording", "part.csv"))


if __name__ == "__main__":
    harness.main()
