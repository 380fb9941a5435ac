"""abbe run --recording: errors added to recorded points instead of to nominal ones."""
import json
import re

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

    def test_points_of_the_surface_are_no_centres_of_the_tip(self):
        """Whether the file has the normals or leaves them to the program."""
        self.abbe("record", PROGRAM, "-o", "rec.csv")
        tips, _ = self.size("--recording", "rec.csv")
        lines = (self.folder / "rec.csv").read_text().replace("# point: tip_centre\n", "# point: surface\n").splitlines()
        head = next(k for k, line in enumerate(lines) if not line.startswith("#"))
        columns = lines[head].split(",")
        radius = 2.0  # of the stylus of the program
        rows = [dict(zip(columns, line.split(","))) for line in lines[head + 1 :]]
        for row in rows:
            for axis in "xyz":
                for column in (axis, "t" + axis):
                    row[column] = str(float(row[column]) - radius * float(row["n" + axis]))
        for kept in (columns, ["feature", "touch", "x", "y", "z"]):
            text = "\n".join([*lines[:head], ",".join(kept), *(",".join(row[c] for c in kept) for row in rows)])
            surface, _ = self.size("--recording", self.write("surface.csv", text + "\n"))
            for one, other in zip(tips["characteristics"], surface["characteristics"]):
                self.assertAlmostEqual(one["reference"], other["reference"], delta=1e-6)

    def test_every_touch_must_be_recorded(self):
        self.abbe("record", PROGRAM, "-o", "rec.csv")
        lines = (self.folder / "rec.csv").read_text().splitlines()
        self.write("short.csv", "\n".join(lines[:-1]) + "\n")
        self.assertIn("short.csv: the program makes touch 25 of 'BALL'", self.refused("E0560", "run", PROGRAM, "--recording", "short.csv"))

    def test_what_a_diagnosis_refuses_is_refused_here(self):
        """Another unit, another tip, other touches: whatever the recording says its targets were, those of the program count."""
        self.abbe("record", PROGRAM, "-o", "rec.csv")
        head, *rows = [line for line in (self.folder / "rec.csv").read_text().splitlines() if not line.startswith("#")]
        said = [line for line in (self.folder / "rec.csv").read_text().splitlines() if line.startswith("#")]
        columns = head.split(",")

        def altered(name, value):
            fields = [row.split(",") for row in rows]
            for row in fields:
                row[columns.index(name)] = value(row[columns.index(name)])
            return [",".join(row) for row in fields]

        def recording(rows, said=said):
            return self.write("other.csv", "\n".join([*said, head, *rows]) + "\n")

        def refused(code, rows, said=said):
            return self.refused(code, "run", PROGRAM, "--machines", 20, "--recording", recording(rows, said))

        inches = [",".join(str(float(v) / 25.4) if c in "xyz" else v for c, v in zip(columns, row.split(","))) for row in rows]
        self.assertIn("inches", refused("E0701", inches))
        self.assertIn("every touch is 2.000 mm too far out", refused("E0701", rows, [line.replace("tip_centre", "surface") for line in said]))
        self.assertIn("keep the rows of one", refused("E0559", rows + altered("run", lambda _: "2")))
        self.assertIn("'CUBE' touch 1", refused("E0544", rows + [row.replace("BALL,", "CUBE,") for row in rows[:1]]))
        self.assertIn("was made with a ball of 7 mm", refused("E0545", rows, [re.sub(r"diameter_mm \S+", "diameter_mm 7", line) for line in said]))
        twice = rows[0].split(",")
        twice[columns.index("x")] = str(float(twice[columns.index("x")]) + 0.1)
        refused("E0713", [*rows, ",".join(twice)])
        # A part that is put down elsewhere is measured there.
        moved = [",".join(str(float(v) + 3) if c == "x" else v for c, v in zip(columns, row.split(","))) for row in rows]
        self.abbe("run", PROGRAM, "--machines", 20, "--recording", recording(moved))

    def test_points_in_part_coordinates_are_no_points_of_the_machine(self):
        self.abbe("record", PROGRAM, "-o", "rec.csv")
        text = (self.folder / "rec.csv").read_text()
        self.assertIn("# frame: mcs\n", text)
        self.write("part.csv", text.replace("# frame: mcs\n", "# frame: part\n"))
        self.assertIn("part.csv: its points are in part coordinates", self.refused("E0525", "run", PROGRAM, "--recording", "part.csv"))


if __name__ == "__main__":
    harness.main()
